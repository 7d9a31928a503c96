// The current bench as text, and a bench from a text.

import { effect } from '@preact/signals-core';
import { setRunning, setSpeed } from '../actions';
import { loaded } from '../codec';
import { restore, select, setup } from '../sim/link';
import * as state from '../state';
import { D } from '../views/texts';
import { NoBench, read, write, type Bench } from './bench';
import { pack, unpack } from './pack';

/** The key of a bench in an address: `#bench=…`. */
const KEY = 'bench=';

/** With its frames the run is repeated; without them only its result is restored. */
export async function now(trace: boolean): Promise<Bench> {
  const bench = {
    trace,
    now: state.now.peek(),
    speed: state.speed.peek(),
    running: state.running.peek(),
    node: state.selectedNode.peek(),
    entries: [...state.journal.entries],
  };
  if (trace) return bench;
  const entries = await setup();
  return entries ? { ...bench, now: 0, entries } : { ...bench, trace: true };
}

export function open(bench: Bench): void {
  const { entries, trace, node } = bench;
  restore(entries, trace ? bench.now : 0, !trace);
  setSpeed(bench.speed);
  setRunning(bench.running);
  // Selects the device of the bench as soon as it exists.
  const stop = effect(() => {
    if (state.devices.value.length <= node || state.replaying.value) return;
    queueMicrotask(() => {
      stop();
      select(node);
    });
  });
}

export const hashOf = async (bench: Bench): Promise<string> => `#${KEY}${await pack(write(bench))}`;

/** Opens the bench in an address; false, with a message, if it has none. */
export async function openHash(hash: string): Promise<boolean> {
  return tried(async () => open(read(await unpack(hash.slice(KEY.length + 1)))), D.share.badLink);
}

/** Opens a text that `write` made. */
export async function openText(text: string, name: string): Promise<boolean> {
  return tried(() => open(read(text)), (why) => D.share.badFile(name, why));
}

async function tried(action: () => void | Promise<void>, message: (why: string) => string): Promise<boolean> {
  try {
    // The module checks the text.
    await loaded;
    await action();
    return true;
  } catch (error) {
    const why = error instanceof NoBench ? error.message : 'cut';
    state.toast.value = { text: message(D.share.why[why] ?? ''), tone: 'error' };
    return false;
  }
}
