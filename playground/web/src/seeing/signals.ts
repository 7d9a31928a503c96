// Values that can be plotted: objects in PDOs, decoded from the frames of the capture with the
// current mapping, and objects of the simulation, which need no frame.

import { signal } from '@preact/signals-core';
import * as state from '../state';
import { mappedValues } from '../codec';
import { address } from '../format';
import { askEach } from '../sim/link';
import type { ObjectRecord, Pdo } from '../sim/api';
import { standIn } from '../views/object-search';
import { S } from './texts';

/** Position of a mapped object in the frames of its PDO. */
interface Place {
  id: number;
  extended: boolean;
  first: number;
  bits: number;
}

/** A value over time. */
export interface Plottable {
  /** Key: `keyOf` for an object of the simulation; node, PDO and object for a mapped one. */
  key: string;
  name: string;
  object: ObjectRecord;
  /** Null for a value of the simulation. */
  place: Place | null;
}

/** The motion of the shaft, for which not every encoder has an object. No object has index 0. */
const shaft = (): ObjectRecord => standIn({ index: 0, sub: 0, name: S.plot.shaft, type: 'REAL64', bits: 64 });

const isNumeric = (object: ObjectRecord): boolean => /^(UNSIGNED|INTEGER|REAL|BOOLEAN)/.test(object.type) && object.access !== 'wo';

const titleOf = (object: ObjectRecord): string => `${address(object.index, object.sub)} ${object.name}`;

/** The objects of the selected device that the simulation can read. */
export const live = (): Plottable[] =>
  [shaft(), ...(state.device.value?.objects ?? [])]
    .filter(isNumeric)
    .map((object) => ({ key: String(state.keyOf(object.index, object.sub)), name: object.index === 0 ? object.name : titleOf(object), object, place: null }));

/** The objects in the PDOs of all devices. */
export const mapped = signal<Plottable[]>([]);

const EXTENDED = 1 << 29;

/** The objects in one PDO. A dummy entry has no value. */
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

/** Reads the PDOs of the devices. */
export async function learn(): Promise<void> {
  const nodes = state.devices.peek().map((device, number) => state.statuses.peek()[number]?.nodeId ?? device.nodeId);
  const pdos = await askEach('pdos', nodes.map((_, number) => [number]));
  const found = pdos.flatMap((list, number) => (list ?? []).flatMap((pdo) => ofPdo(nodes[number]!, number, pdo)));
  // A device without power has no mapping; the last known one still decodes the capture.
  const isSilent = (one: Plottable): boolean => nodes.some((node, number) => one.key.startsWith(`${node} `) && !state.statuses.peek()[number]?.powered);
  const kept = mapped.peek().filter((one) => isSilent(one) && !found.some(({ key }) => key === one.key));
  const next = [...found, ...kept];
  if (JSON.stringify(next) !== JSON.stringify(mapped.peek())) mapped.value = next;
}

/** Milliseconds after which a changed mapping is read. */
const LEARNED = 1000;

/** Reads again while the view is open. */
export function keepLearning(): () => void {
  void learn();
  const timer = window.setInterval(() => void learn(), LEARNED);
  return () => clearInterval(timer);
}

/** The values in packed frames: three numbers each, place in the batch, microseconds, value. */
export const valuesOf = ({ object }: Plottable, place: Place, frames: Uint8Array): Float64Array =>
  mappedValues(frames, place.id, place.extended, place.first, place.bits, object.type);
