// A bench as text: everything that was done to it, with its moments. One form for links,
// files and the autosave; what comes in is checked to the last field, for it comes from outside.

import type { Entry, Input } from '../sim/api';

export const VERSION = 1;

export interface Bench {
  /** With the frames of the run so far. */
  trace: boolean;
  /** The moment to go on from, in virtual microseconds. */
  now: number;
  speed: number;
  running: boolean;
  /** The device that the panels show. */
  node: number;
  entries: Entry[];
}

/** Why a text is no bench. */
export class NoBench extends Error {}

/** Inputs of one bench; more would take minutes to make again. */
const MOST_ENTRIES = 200_000;
/** Longest EDS text, and longest lesson. */
const LONGEST_TEXT = 8_000_000;
/** Latest moment: a year. */
const LATEST = 366 * 86_400e6;

type Kind = 'text' | 'place' | 'count' | 'number' | 'flag' | 'bytes' | 'name' | 'steps' | 'source' | 'dip';

/** The fields of each input; those with a question mark may be missing, those with a bar null. */
const FIELDS: Record<Input['op'], Record<string, Kind | `${Kind}?` | `${Kind}|`>> = {
  add: { source: 'source', nodeId: 'place', place: 'place?' },
  remove: { node: 'place' },
  send: { id: 'count', data: 'bytes', extended: 'flag', remote: 'flag' },
  repeat: { key: 'count', id: 'count', data: 'bytes', extended: 'flag', remote: 'flag', micros: 'count' },
  power: { node: 'place', on: 'flag' },
  turn: { node: 'place', turns: 'number' },
  rpm: { node: 'place', rpm: 'number' },
  follow: { node: 'place', steps: 'steps', repeats: 'flag' },
  switches: { node: 'place', id: 'place?', dip: 'dip?' },
  fault: { node: 'place', name: 'name', on: 'flag' },
  line: { real: 'flag', terminators: 'place', rate: 'count|' },
  seed: { seed: 'count' },
  plug: { station: 'place', on: 'flag' },
  restart: { station: 'place' },
  cut: { node: 'place', bytes: 'count' },
  eeprom: { node: 'place', bytes: 'bytes' },
  deliver: { node: 'place', id: 'count', data: 'bytes' },
  lesson: { text: 'text' },
  leave: {},
  script: { text: 'text' },
};

export function write(bench: Bench): string {
  const { entries, ...rest } = bench;
  const bytes = (_key: string, value: unknown): unknown => (value instanceof Uint8Array ? toBase64(value) : value);
  return JSON.stringify({ odkit: VERSION, ...rest, entries: entries.map(({ at, input }) => [at, input]) }, bytes);
}

/** Reads what `write` made, whoever had it in hands meanwhile. */
export function read(text: string): Bench {
  let all: unknown;
  try {
    all = JSON.parse(text);
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
    return { at: number(pair[0], 0, LATEST), input: input(pair[1]) };
  });
  if (entries.some(({ at }, i) => i > 0 && at < entries[i - 1]!.at)) throw new NoBench('cut');
  return {
    trace: flag(it['trace']),
    now: number(it['now'], 0, LATEST),
    speed: number(it['speed'], 0.001, 10_000),
    running: flag(it['running']),
    node: number(it['node'], 0, 255),
    entries,
  };
}

function input(value: unknown): Input {
  const it = record(value);
  const op = it['op'];
  if (typeof op !== 'string' || !Object.hasOwn(FIELDS, op)) throw new NoBench('newer');
  const made: Record<string, unknown> = { op };
  for (const [name, wanted] of Object.entries(FIELDS[op as Input['op']])) {
    const given = it[name];
    if (given === undefined && wanted.endsWith('?')) continue;
    made[name] = given === null && wanted.endsWith('|') ? null : field(given, wanted.replace(/[?|]$/, '') as Kind);
  }
  return made as Input;
}

function field(value: unknown, kind: Kind): unknown {
  switch (kind) {
    case 'place':
      return whole(value, 255);
    case 'count':
      return whole(value, 0xffff_ffff);
    case 'number':
      return number(value, -1e9, 1e9);
    case 'flag':
      return flag(value);
    case 'text':
      return text(value, LONGEST_TEXT);
    case 'name':
      return text(value, 64);
    case 'bytes':
      return fromBase64(text(value, 200_000));
    case 'steps':
      if (!Array.isArray(value) || value.length > 2000) throw new NoBench('cut');
      return value.map((one) => number(one, -1e9, 1e9));
    case 'dip': {
      const it = record(value);
      return { bit: whole(it['bit'], 7), on: flag(it['on']) };
    }
    case 'source': {
      const it = record(value);
      const name = text(it['name'], 200);
      if (it['kind'] === 'builtin') return { kind: 'builtin', name };
      if (it['kind'] !== 'eds') throw new NoBench('newer');
      return { kind: 'eds', name, text: text(it['text'], LONGEST_TEXT), lenient: flag(it['lenient']) };
    }
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

function whole(value: unknown, high: number): number {
  if (!Number.isInteger(value)) throw new NoBench('cut');
  return number(value, 0, high);
}

function flag(value: unknown): boolean {
  if (typeof value !== 'boolean') throw new NoBench('cut');
  return value;
}

function text(value: unknown, longest: number): string {
  if (typeof value !== 'string' || value.length > longest) throw new NoBench('cut');
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
