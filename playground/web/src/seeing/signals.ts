// What can be plotted: objects as PDOs carry them, taken from the frames of the capture by the mapping
// that is valid now, and objects as the simulation has them, without a frame on the bus.

import { signal } from '@preact/signals-core';
import * as state from '../state';
import { mappedValues } from '../codec';
import { address } from '../format';
import { askEach } from '../sim/link';
import type { ObjectRecord, Pdo } from '../sim/api';
import { standIn } from '../views/object-search';
import { S } from './texts';

/** Place of a mapped object in the frames of its PDO. */
export interface Place {
  id: number;
  extended: boolean;
  first: number;
  bits: number;
}

/** Something that has a value over time. */
export interface Plottable {
  /** Of an object of the simulation its `keyOf`; of a mapped one its node, PDO and object. */
  key: string;
  name: string;
  object: ObjectRecord;
  /** Null: the simulation is asked. */
  place: Place | null;
}

/** The real motion of the shaft; not every encoder has an object for it. A dictionary has no value with index 0. */
const SHAFT = standIn({ index: 0, sub: 0, name: S.plot.shaft, type: 'REAL64', bits: 64 });

const isNumeric = (object: ObjectRecord): boolean => /^(UNSIGNED|INTEGER|REAL|BOOLEAN)/.test(object.type) && object.access !== 'wo';

const titleOf = (object: ObjectRecord): string => `${address(object.index, object.sub)} ${object.name}`;

/** The objects of the selected device that the simulation can be asked for. */
export const live = (): Plottable[] =>
  [SHAFT, ...(state.device.value?.objects ?? [])]
    .filter(isNumeric)
    .map((object) => ({ key: String(state.keyOf(object.index, object.sub)), name: object === SHAFT ? object.name : titleOf(object), object, place: null }));

/** The objects in the PDOs of all devices. */
export const mapped = signal<Plottable[]>([]);

const EXTENDED = 1 << 29;

/** Of one PDO. A dummy entry fills a gap, and has no value. */
function ofPdo(node: number, device: number, { transmits, number, cobId, entries }: Pdo): Plottable[] {
  if (!cobId?.valid) return [];
  const known = new Map(state.devices.peek()[device]?.objects.map((object) => [state.keyOf(object.index, object.sub), object]));
  const pdo = `${transmits ? 'T' : 'R'}PDO${number}`;
  let first = 0;
  return entries.flatMap(({ index, sub, bits }) => {
    const place = { id: cobId.id, extended: (cobId.raw & EXTENDED) !== 0, first, bits };
    first += bits;
    const object = known.get(state.keyOf(index, sub)) ?? standIn({ index, sub, name: '', type: `UNSIGNED${bits}`, bits });
    const name = S.plot.mapped(state.devices.peek().length > 1 ? node : null, pdo, titleOf(object).trim());
    return index < 0x20 || !/^(UNSIGNED|INTEGER|REAL|BOOLEAN)/.test(object.type) ? [] : [{ key: `${node} ${pdo} ${address(index, sub, true)}`, name, object, place }];
  });
}

/** Asks the devices for their PDOs. */
export async function learn(): Promise<void> {
  const nodes = state.devices.peek().map((device, number) => state.statuses.peek()[number]?.nodeId ?? device.nodeId);
  const pdos = await askEach('pdos', nodes.map((_, number) => [number]));
  const found = pdos.flatMap((list, number) => (list ?? []).flatMap((pdo) => ofPdo(nodes[number]!, number, pdo)));
  // Without power a device has no mapping; the last one that was known still decodes what is captured.
  const isSilent = (one: Plottable): boolean => nodes.some((node, number) => one.key.startsWith(`${node} `) && !state.statuses.peek()[number]?.powered);
  const kept = mapped.peek().filter((one) => isSilent(one) && !found.some(({ key }) => key === one.key));
  const next = [...found, ...kept];
  if (JSON.stringify(next) !== JSON.stringify(mapped.peek())) mapped.value = next;
}

/** Milliseconds after which a changed mapping is known. */
const LEARNED = 1000;

/** Repeats the reading while the view is open. */
export function keepLearning(): () => void {
  void learn();
  const timer = window.setInterval(() => void learn(), LEARNED);
  return () => clearInterval(timer);
}

/** The values in packed frames: three numbers each, place in the batch, microseconds, value. */
export const valuesOf = ({ object }: Plottable, place: Place, frames: Uint8Array): Float64Array =>
  mappedValues(frames, place.id, place.extended, place.first, place.bits, object.type);
