// The nodes of a real bus: nodes that send, nodes that respond, and their descriptions.

import { signal } from '@preact/signals-core';
import type { Outcome, Source } from '../sim/api';
import { ask, describe, hooks, maySend, select, use } from '../sim/link';
import * as state from '../state';
import { R } from './texts';
import { identify } from './connect';

/** Number of SDO requests at the same time during a search for nodes. */
const AT_ONCE = 32;
/** Node IDs of CANopen. */
const ALL = 127;

const SILENT: Outcome = { job: 0, kind: 'silent', bytes: null, words: '', wantsPdoOff: false };

/** The current action, in words. */
export const doing = signal('');
export const isBusy = signal(false);
/** Node IDs that responded to a search. */
export const answered = signal<ReadonlySet<number>>(new Set());

let isWanted = true;
export const stop = (): void => void (isWanted = false);

const read = (node: number, index: number, sub: number): Promise<Outcome> =>
  ask((ticket) => ({ op: 'transfer', ticket, node, index, sub, bytes: null }), SILENT);

const number = ({ bytes }: Outcome): number | null =>
  bytes && bytes.length <= 4 && bytes.length > 0 ? [...bytes].reduceRight((value, byte) => value * 256 + byte, 0) : null;

/** Only one action at a time, and only if sending is on. */
async function alone(work: () => Promise<string>): Promise<void> {
  if (isBusy.peek()) return;
  if (!maySend()) return hooks.held();
  isBusy.value = isWanted = true;
  doing.value = await work();
  isBusy.value = false;
}

/** Reads 1000h of every node ID. */
export const search = (): Promise<void> =>
  alone(async () => {
    const found = new Set<number>();
    let next = 1;
    const one = async (): Promise<void> => {
      while (next <= ALL && isWanted && maySend()) {
        const node = next++;
        doing.value = R.scanning(node);
        const { kind } = await read(node, 0x1000, 0);
        // An abort is a response, too.
        if (kind !== 'silent') answered.value = found.add(node) && new Set(found);
      }
    };
    await Promise.all(Array.from({ length: AT_ONCE }, one));
    return R.found(found.size);
  });

/** The mandatory objects of every node. */
async function plain(name: string): Promise<Source> {
  const text = await use('plainEds', name);
  return { kind: 'eds', name, text: 'value' in text ? text.value : '', lenient: true };
}

/** Adds the description of a node: the built-in device with its identity, else the mandatory objects. */
export async function show(node: number): Promise<void> {
  let source = await plain(R.node(node));
  if (maySend() && !isBusy.peek()) {
    await alone(async () => {
      doing.value = R.asked(node);
      const [vendor, product] = [number(await read(node, 0x1018, 1)), number(await read(node, 0x1018, 2))];
      if (vendor === null) return R.noAnswer(node);
      const known = product === null ? null : await identify(vendor, product);
      if (known) source = { kind: 'builtin', name: known };
      else {
        const { bytes } = await read(node, 0x1008, 0);
        const name = new TextDecoder().decode(bytes ?? new Uint8Array(0)).replace(/[^ -~]/g, '').trim();
        if (name) source = await plain(name);
      }
      return '';
    });
  }
  const added = await describe({ op: 'add', source, nodeId: node });
  if (added.node !== null) select(added.node);
}

/** Reads all objects of the selected node. */
export const readAll = (): Promise<void> =>
  alone(async () => {
    const node = state.nodeId.peek();
    const objects = (state.device.peek()?.objects ?? []).filter(({ access }) => access !== 'wo');
    let [done, silent] = [0, 0];
    for (const { index, sub } of objects) {
      if (!isWanted || !maySend()) break;
      const { kind } = await read(node, index, sub);
      silent = kind === 'silent' ? silent + 1 : 0;
      if (silent === 3) return R.noAnswer(node);
      doing.value = R.reading(++done, objects.length);
    }
    return R.reading(done, objects.length);
  });
