// Formats of numbers, bytes, addresses and frames on the page.

import type { ObjectRecord, Value } from './sim/api';
import type { Packed } from './sim/packed';

/** A number with thin spaces between its thousands. */
export const grouped = (value: number | bigint): string => value.toLocaleString('en').replaceAll(',', '\u2009');

export const hexIndex = (index: number): string => `${index.toString(16).toUpperCase().padStart(4, '0')}h`;

/** `6004h`, or `1018h:02` if the object has more than sub-index 0. */
export function address(index: number, sub: number, always = false): string {
  return sub === 0 && !always ? hexIndex(index) : `${hexIndex(index)}:${sub.toString(16).toUpperCase().padStart(2, '0')}`;
}

const isFloat = (object: ObjectRecord): boolean => object.type.startsWith('REAL');

/** A value to show: integers grouped, codes and bits in hexadecimal. */
export function showValue(value: Value, object: ObjectRecord): string {
  if (value === null) return '–';
  if (typeof value === 'string') return `“${value}”`;
  if (typeof value === 'boolean') return value ? 'true' : 'false';
  if (value instanceof Uint8Array) {
    return value.length ? hexBytes(value) : 'empty';
  }
  if (isFloat(object)) return String(value);
  return isFlags(object) ? hexValue(value, object.bits) : grouped(value);
}

/** Returns whether the value is a code or a set of bits, which is shown in hexadecimal. */
function isFlags(object: ObjectRecord): boolean {
  return /COB|identifier|\btype\b|mapp|\bbits?\b|register|alarm|warning|vendor|product|revision|version|options|parameters?$|status|content|field|entry|store|save|restore/i.test(object.name) && object.sub !== 0
    ? true
    : object.sub === 0 && object.parent === null && /COB|device type|register|alarm|warning|options|operating (parameter|status)|version/i.test(object.name);
}

function hexValue(value: number | bigint, bits: number): string {
  const width = Math.max(1, Math.ceil((bits || 32) / 4));
  const masked = BigInt.asUintN(bits || 64, BigInt(value));
  return `${masked.toString(16).toUpperCase().padStart(width, '0')}h`;
}

/** The other notation of a number, for the detail line. */
export function otherSpelling(value: Value, object: ObjectRecord): string {
  if (typeof value !== 'number' && typeof value !== 'bigint') return '';
  if (isFloat(object)) return '';
  return isFlags(object) ? grouped(value) : hexValue(value, object.bits);
}

export function sameValue(a: Value, b: Value): boolean {
  if (a instanceof Uint8Array && b instanceof Uint8Array) {
    return a.length === b.length && a.every((byte, i) => byte === b[i]);
  }
  return a === b;
}

const HEX = Array.from({ length: 256 }, (_, byte) => byte.toString(16).toUpperCase().padStart(2, '0'));

/** `00` to `FF`. */
export const hexByte = (byte: number): string => HEX[byte & 255]!;

/** Bytes with a space between them. */
export function hexBytes(data: Uint8Array): string {
  let text = '';
  for (const byte of data) text += text ? ` ${HEX[byte]}` : HEX[byte];
  return text;
}

export const hexId = (id: number, extended: boolean): string =>
  id.toString(16).toUpperCase().padStart(extended ? 8 : 3, '0');

/** A frame as a user would type it: `601#40 04 60 00`. */
export function typedForm(frame: Pick<Packed, 'id' | 'extended' | 'remote' | 'data'> & { dlc?: number }): string {
  const body = frame.remote ? `R${(frame.dlc ?? frame.data.length) || ''}` : hexBytes(frame.data);
  return `${hexId(frame.id, frame.extended)}#${body}`;
}
