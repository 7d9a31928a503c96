// A bench as text: all its inputs with their times. Links, files and the autosave have
// the same format. Every field is checked when it is read, since anybody can write it.

import type { Entry, Input } from '../sim/api';
import { checkRun, readInput } from '../codec';

const VERSION = 1;

export interface Bench {
  /** With the frames so far. */
  trace: boolean;
  /** The moment to continue from, in virtual microseconds. */
  now: number;
  speed: number;
  running: boolean;
  /** The selected device. */
  node: number;
  entries: Entry[];
}

/** Reason why a text is not a valid bench. */
export class NoBench extends Error {}

/** Maximum number of inputs; more would take minutes to repeat. */
const MOST_ENTRIES = 200_000;
/** Fields of inputs that contain bytes. */
const BYTES: ReadonlySet<string> = new Set(['data', 'bytes']);
/** Maximum time of this format: a year. `checkRun` limits the length of a run. */
const LATEST = 366 * 86_400e6;

export function write(bench: Bench): string {
  const { entries, ...rest } = bench;
  const bytes = (_key: string, value: unknown): unknown => (value instanceof Uint8Array ? toBase64(value) : value);
  return JSON.stringify({ odkit: VERSION, ...rest, entries: entries.map(({ at, input }) => [at, input]) }, bytes);
}

/** Parses the text of `write`, which may have been changed. */
export function read(text: string): Bench {
  let all: unknown;
  try {
    all = JSON.parse(text, (key, value: unknown) => (BYTES.has(key) && typeof value === 'string' ? fromBase64(value) : value));
  } catch {
    throw new NoBench('cut');
  }
  const it = record(all);
  if (typeof it['odkit'] !== 'number') throw new NoBench('other');
  if (it['odkit'] > VERSION) throw new NoBench('newer');
  const list = it['entries'];
  if (!Array.isArray(list) || list.length > MOST_ENTRIES) throw new NoBench('cut');
  const entries = list.map((pair: unknown): Entry => {
    if (!Array.isArray(pair)) throw new NoBench('cut');
    return { at: number(pair[0], 0, LATEST), input: checked(pair[1]) };
  });
  if (entries.some(({ at }, i) => i > 0 && at < entries[i - 1]!.at)) throw new NoBench('cut');
  const now = number(it['now'], 0, LATEST);
  checkedBy(() => checkRun(entries, now));
  return {
    trace: flag(it['trace']),
    now,
    speed: number(it['speed'], 0.001, 10_000),
    running: flag(it['running']),
    node: number(it['node'], 0, 255),
    entries,
  };
}

/** The module knows the inputs and the valid values of their fields. */
const checked = (value: unknown): Input => checkedBy(() => readInput(value));

function checkedBy<T>(check: () => T): T {
  try {
    return check();
  } catch (error) {
    throw new NoBench(error instanceof Error ? error.message : 'cut');
  }
}

function record(value: unknown): Record<string, unknown> {
  if (typeof value !== 'object' || value === null || Array.isArray(value)) throw new NoBench('other');
  return value as Record<string, unknown>;
}

function number(value: unknown, low: number, high: number): number {
  if (typeof value !== 'number' || !(value >= low && value <= high)) throw new NoBench('cut');
  return value;
}

function flag(value: unknown): boolean {
  if (typeof value !== 'boolean') throw new NoBench('cut');
  return value;
}

/** Bytes as text for addresses: A–Z, a–z, 0–9, `-` and `_`. */
export function toBase64(bytes: Uint8Array): string {
  let all = '';
  for (let at = 0; at < bytes.length; at += 0x8000) all += String.fromCharCode(...bytes.subarray(at, at + 0x8000));
  return btoa(all).replaceAll('+', '-').replaceAll('/', '_').replace(/=+$/, '');
}

export function fromBase64(text: string): Uint8Array<ArrayBuffer> {
  try {
    const all = atob(text.replaceAll('-', '+').replaceAll('_', '/'));
    return Uint8Array.from(all, (char) => char.charCodeAt(0));
  } catch {
    throw new NoBench('cut');
  }
}
