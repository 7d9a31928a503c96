// Reads the objects and connections of the selected device that a view of a machine shows, some times a second.

import { signal } from '@preact/signals-core';
import type { Address, Pin, Snapshot, Value } from '../sim/api';
import { askEach, listen } from '../sim/link';
import * as state from '../state';

/** Milliseconds between two looks. */
const EVERY = 60;

/** The connections of the selected device. */
export const pins = signal<readonly Pin[]>([]);
/** The values of the wanted objects, by `keyOf`, and their virtual time. */
export const seen = signal<{ at: number; node: number; values: ReadonlyMap<number, Value> }>({ at: 0, node: -1, values: new Map() });

let wanted: readonly Address[] = [];
let lookedAt = -Infinity;
let isAsking = false;

/** Sets the objects to look at. */
export function want(objects: readonly Address[]): void {
  wanted = objects;
}

/** A number of an object, or null. */
export function number(index: number, sub = 0): number | null {
  const value = seen.value.values.get(state.keyOf(index, sub));
  return typeof value === 'number' || typeof value === 'bigint' ? Number(value) : null;
}

async function look({ now }: Snapshot): Promise<void> {
  if (isAsking || performance.now() - lookedAt < EVERY) return;
  lookedAt = performance.now();
  isAsking = true;
  const node = state.selectedNode.peek();
  const objects = wanted;
  const [values, [found]] = await Promise.all([
    askEach('read', objects.map(({ index, sub }) => [node, index, sub] as [number, number, number])),
    askEach('pins', [[node]]),
  ]);
  isAsking = false;
  if (node !== state.selectedNode.peek()) return;
  pins.value = found ?? [];
  seen.value = { at: now, node, values: new Map(objects.map(({ index, sub }, i) => [state.keyOf(index, sub), values[i] ?? null])) };
}

/** Looks until the returned function is called. */
export function start(): () => void {
  lookedAt = -Infinity;
  return listen((snapshot) => void look(snapshot));
}
