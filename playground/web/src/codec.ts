// The page's own instance of the WebAssembly module, for questions that views ask synchronously.

import { signal } from '@preact/signals-core';
import { decodeValue, encodeValue, frameTemplates, initSync, readLine as read, tagNames, tags as tagsOf, typeRange, type LineResult } from './wasm/core/od_playground';
import type { FrameTemplate, ObjectRecord, Value } from './sim/api';
import { T } from './texts';
import { grouped } from './format';
import { said } from './language';

export { checkRun, frameBits, mappedValues, readInput, readValues, Statistics, Transfers } from './wasm/core/od_playground';

/** False until the worker has sent the module. */
const isReady = signal(false);

let arrived: () => void;
/** Resolves when the module can be used. */
export const loaded = new Promise<void>((resolve) => (arrived = resolve));

export function begin(module: WebAssembly.Module): void {
  if (!isReady.peek()) initSync({ module });
  isReady.value = true;
  arrived();
}

export interface Tag {
  service: string;
  /** Names in the console: `PDO1`, `SDO`, … */
  text: string;
}

/** A frame that was disturbed on the bus line. */
export const ERROR: Tag = { service: 'ERR', text: 'ERR' };

let known: Tag[] = [];

/** The services, in the order of their numbers in `tags`. */
export function tagAt(place: number): Tag {
  if (known.length === 0) known = tagNames().map((text) => ({ text, service: text.replace(/^R?(PDO)\d$/, '$1') }));
  return known[place]!;
}

/** For each packed frame the numbers that TAG reads: service, node, whether there is an object, the object. */
export const tags = (frames: Uint8Array): Uint32Array => tagsOf(frames);

/** A frame that a user typed. */
export interface Typed {
  id: number;
  extended: boolean;
  remote: boolean;
  /** A remote frame has as many zeros as bytes it requests. */
  data: Uint8Array;
}

export type ReadLine = { frame: Typed } | { error: string; at: number };

/** Parses a frame, or a line that means one, for a node with these objects. */
export function readLine(text: string, nodeId: number, find: (index: number, sub: number) => ObjectRecord | undefined): ReadLine {
  if (!isReady.value || text.trim() === '') return { error: T.typed.frame, at: 0 };
  const result: LineResult = read(text, nodeId, { typeOf: (index, sub) => find(index, sub)?.type });
  return result.error === undefined ? { frame: result } : { error: said(result.error), at: result.at };
}

/** Example frames for a node. */
export const templates = (nodeId: number): FrameTemplate[] => (isReady.value ? frameTemplates(nodeId) : []);

type Encoded = { bytes: Uint8Array; note: string } | { error: string };

/** The bytes of a typed value for an object, and its description. */
export function encode(text: string, object: ObjectRecord): Encoded {
  try {
    const bytes = encodeValue(object.type, text);
    return { bytes, note: noteOn(bytes, object) };
  } catch (error) {
    return { error: said(error instanceof Error ? error.message : String(error)) };
  }
}

function noteOn(bytes: Uint8Array, object: ObjectRecord): string {
  if (object.type.endsWith('_STRING') && object.type !== 'OCTET_STRING') return T.typed.characters(bytes.length);
  const limits = range(object);
  if (!limits) return object.type;
  const value = decode(bytes, object);
  if (typeof value !== 'number' && typeof value !== 'bigint') return object.type;
  return value < limits.low || value > limits.high ? T.typed.outside(grouped(limits.low), grouped(limits.high)) : object.type;
}

/** The value that the bytes of an object encode. */
export const decode = (bytes: Uint8Array, object: ObjectRecord): Value => decodeValue(object.type, bytes);

/** Lowest and highest value: the object's own limits, or those of its type. */
export function range(object: ObjectRecord): { low: number | bigint; high: number | bigint } | null {
  const [low, high] = typeRange(object.type) as (number | bigint)[];
  if (low === undefined || high === undefined) return null;
  const own = (value: Value, or: number | bigint): number | bigint => (typeof value === 'number' || typeof value === 'bigint' ? value : or);
  return { low: own(object.low, low), high: own(object.high, high) };
}
