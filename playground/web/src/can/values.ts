// Values of the dictionary's types: shown, typed in, and as bytes on the bus.

import type { ObjectRecord, Value } from '../sim/api';
import { T } from '../texts';

/** A number with thin spaces between its thousands. */
export const grouped = (value: number | bigint): string => value.toLocaleString('en').replaceAll(',', '\u2009');

export const hexIndex = (index: number): string => `${index.toString(16).toUpperCase().padStart(4, '0')}h`;

/** `6004h`, or `1018h:02` where there is more than sub-index 0. */
export function address(index: number, sub: number, always = false): string {
  return sub === 0 && !always ? hexIndex(index) : `${hexIndex(index)}:${sub.toString(16).toUpperCase().padStart(2, '0')}`;
}

const isInteger = (object: ObjectRecord): boolean => /^(UN)?SIGNED|^INTEGER|^BOOLEAN/.test(object.type);
const isFloat = (object: ObjectRecord): boolean => object.type.startsWith('REAL');
const isText = (object: ObjectRecord): boolean => /_STRING$/.test(object.type) && object.type !== 'OCTET_STRING';

/** A value for people: integers grouped, with hexadecimal where that is how it is read. */
export function showValue(value: Value, object: ObjectRecord): string {
  if (value === null) return '–';
  if (typeof value === 'string') return `“${value}”`;
  if (typeof value === 'boolean') return value ? 'true' : 'false';
  if (value instanceof Uint8Array) {
    return value.length ? Array.from(value, (byte) => byte.toString(16).toUpperCase().padStart(2, '0')).join(' ') : 'empty';
  }
  if (isFloat(object)) return String(value);
  return isFlags(object) ? hexValue(value, object.bits) : grouped(value);
}

/** Is the value of this object a code or a set of bits, better read in hexadecimal? */
function isFlags(object: ObjectRecord): boolean {
  return /COB|identifier|\btype\b|mapp|\bbits?\b|register|alarm|warning|vendor|product|revision|version|options|parameters?$|status|content|field|entry|store|save|restore/i.test(object.name) && object.sub !== 0
    ? true
    : object.sub === 0 && object.parent === null && /COB|device type|register|alarm|warning|options|operating (parameter|status)|version/i.test(object.name);
}

export function hexValue(value: number | bigint, bits: number): string {
  const width = Math.max(1, Math.ceil((bits || 32) / 4));
  const masked = BigInt.asUintN(bits || 64, BigInt(value));
  return `${masked.toString(16).toUpperCase().padStart(width, '0')}h`;
}

/** The other spelling of a number, for the detail line. */
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

/** Lowest and highest value: the object's own limits, or those of its type. */
export function range(object: ObjectRecord): { low: number | bigint; high: number | bigint } | null {
  if (!isInteger(object) || object.bits === 0) return null;
  const bits = BigInt(object.bits);
  const signed = object.type.startsWith('INTEGER');
  const low = signed ? -(1n << (bits - 1n)) : 0n;
  const high = signed ? (1n << (bits - 1n)) - 1n : (1n << bits) - 1n;
  const own = (value: Value, or: bigint): number | bigint => (typeof value === 'number' || typeof value === 'bigint' ? value : Number(or));
  return { low: own(object.low, low), high: own(object.high, high) };
}

export type Encoded = { bytes: Uint8Array; note: string } | { error: string };

/** Reads what was typed for an object: decimal, 0x or trailing h for hexadecimal, quotes for text. */
export function encode(text: string, object: ObjectRecord): Encoded {
  const typed = text.trim();
  if (typed === '') return { error: T.typed.value };
  const quoted = /^["'“](.*)["'”]$/.exec(typed);
  if (isText(object) || quoted) {
    const content = quoted?.[1] ?? typed;
    const bytes = new TextEncoder().encode(content);
    if (!isText(object) && object.bits && bytes.length * 8 > object.bits) {
      return { error: T.typed.textLength(content, object.bits / 8) };
    }
    return { bytes, note: T.typed.characters(bytes.length) };
  }
  if (isFloat(object)) {
    const value = Number(typed);
    if (!Number.isFinite(value)) return { error: T.typed.number(typed) };
    const bytes = new Uint8Array(object.bits / 8);
    const view = new DataView(bytes.buffer);
    if (object.bits === 64) view.setFloat64(0, value, true);
    else view.setFloat32(0, value, true);
    return { bytes, note: object.type };
  }
  if (!isInteger(object)) {
    const digits = typed.replace(/[\s,]/g, '');
    if (!/^([0-9a-f]{2})*$/i.test(digits)) return { error: T.typed.hexBytes };
    return { bytes: Uint8Array.from(digits.match(/../g) ?? [], (pair) => Number.parseInt(pair, 16)), note: T.typed.asTyped };
  }
  const value = integer(typed);
  if (value === null) return { error: T.typed.whole(typed) };
  const width = BigInt(object.bits || 8);
  const least = -(1n << (width - 1n));
  const most = (1n << width) - 1n;
  if (value < least || value > most) return { error: T.typed.fit(String(value), object.type) };
  const bytes = new Uint8Array(Math.max(1, object.bits / 8));
  let rest = BigInt.asUintN(Number(width), value);
  for (let i = 0; i < bytes.length; i++, rest >>= 8n) bytes[i] = Number(rest & 255n);
  const limits = range(object);
  const outside = limits && (value < BigInt(limits.low) || value > BigInt(limits.high));
  return { bytes, note: outside ? T.typed.outside(grouped(limits.low), grouped(limits.high)) : object.type };
}

function integer(typed: string): bigint | null {
  const text = typed.replace(/[_,\u2009\u202f\u00a0 ]/g, '');
  const hex = /^(-?)(?:0x([0-9a-f]+)|([0-9a-f]+)h)$/i.exec(text);
  if (hex) return BigInt(`0x${hex[2] ?? hex[3]}`) * (hex[1] ? -1n : 1n);
  if (/^(true|false)$/i.test(text)) return text.toLowerCase() === 'true' ? 1n : 0n;
  return /^-?\d+$/.test(text) ? BigInt(text) : null;
}

/** Reads a value back from the bytes of an answer. */
export function decode(bytes: Uint8Array, object: ObjectRecord): Value {
  if (isText(object)) return new TextDecoder('windows-1252').decode(bytes).replace(/\0+$/, '');
  if (isFloat(object) && bytes.length * 8 === object.bits) {
    const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
    return object.bits === 64 ? view.getFloat64(0, true) : view.getFloat32(0, true);
  }
  if (!isInteger(object) || bytes.length > 8 || bytes.length === 0) return bytes;
  let value = 0n;
  for (let i = bytes.length - 1; i >= 0; i--) value = (value << 8n) | BigInt(bytes[i]!);
  if (object.type.startsWith('INTEGER')) value = BigInt.asIntN(object.bits, value);
  else if (object.bits) value = BigInt.asUintN(object.bits, value);
  return value >= Number.MIN_SAFE_INTEGER && value <= Number.MAX_SAFE_INTEGER ? Number(value) : value;
}
