// Frames as people type and save them: cansend's form, looser ones, and candump logs.

import type { Frame } from '../sim/packed';
import { T } from '../texts';

export interface Typed {
  id: number;
  extended: boolean;
  remote: boolean;
  data: Uint8Array;
  /** Length of a remote frame. */
  dlc: number;
}

export type Parsed = { frame: Typed } | { error: string; at: number };

/**
 * Reads a typed frame: `601#4004600000000000`, `601#40 04 60 00`, `601 40 04 60 00`,
 * `601 [4] 40 04 60 00`, `701#R`, `12345678#0102` (eight digits: 29 bits).
 * `at` is the offset of the character that is wrong.
 */
export function parseFrame(text: string): Parsed {
  const fail = (error: string, at: number): Parsed => ({ error, at });
  const head = /^\s*(?:0x)?([^\s#:,]*)h?/i.exec(text);
  const start = text.search(/\S/);
  const digits = head?.[1]?.replace(/h$/i, '') ?? '';
  if (start < 0) return fail(T.typed.frame, 0);
  if (!/^[0-9a-f]+$/i.test(digits)) return fail(T.typed.hexId, start);
  const extended = digits.length > 3;
  const id = Number.parseInt(digits, 16);
  if (extended && (digits.length !== 8 || id > 0x1fffffff)) {
    return fail(T.typed.idLength, start);
  }
  if (!extended && id > 0x7ff) return fail(T.typed.idRange, start);
  let at = head?.[0].length ?? 0;
  const length = /^\s*[#:]?\s*\[(\d)\]/.exec(text.slice(at));
  const separator = /^\s*[#:,]?\s*/.exec(text.slice(at));
  at += (length ?? separator)?.[0].length ?? 0;
  const rest = text.slice(at);
  const remote = /^\s*r(?:tr)?\s*([0-9])?\s*$/i.exec(rest);
  if (remote) {
    const dlc = Number(remote[1] ?? length?.[1] ?? 0);
    if (dlc > 8) return fail(T.typed.bytes, text.length - 1);
    return { frame: { id, extended, remote: true, data: new Uint8Array(0), dlc } };
  }
  const bytes: number[] = [];
  const pattern = /([\s.,_-]*)(0x)?([0-9a-f]{1,2})?/iy;
  let position = 0;
  while (position < rest.length) {
    pattern.lastIndex = position;
    const match = pattern.exec(rest);
    const pair = match?.[3];
    if (!match || pair === undefined) {
      const trailing = position + (match?.[1]?.length ?? 0);
      if (trailing >= rest.length) break;
      return fail(T.typed.digit(rest[trailing] ?? ''), at + trailing);
    }
    const next = rest[match[0].length + position];
    if (pair.length === 1 && next !== undefined && !/[\s.,_-]/.test(next)) {
      return fail(T.typed.digit(next), at + position + match[0].length);
    }
    if (bytes.length === 8) return fail(T.typed.bytes, at + position);
    bytes.push(Number.parseInt(pair, 16));
    position += match[0].length;
  }
  if (length && bytes.length !== Number(length[1])) {
    return fail(`[${length[1]}] promises ${length[1]} bytes, there are ${bytes.length}`, at);
  }
  return { frame: { id, extended, remote: false, data: new Uint8Array(bytes), dlc: bytes.length } };
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

/** A frame as one would type it: `601#40 04 60 00`. */
export function typedForm(frame: Frame): string {
  const body = frame.remote ? `R${frame.dlc || ''}` : hexBytes(frame.data);
  return `${hexId(frame.id, frame.extended)}#${body}`;
}

/** One line of a candump log: `(0.100000) can0 601#4004600000000000`. */
export function candumpLine(frame: Frame): string {
  const seconds = Math.floor(frame.time / 1e6);
  const micros = String(Math.floor(frame.time % 1e6)).padStart(6, '0');
  let body = '';
  if (frame.remote) body = frame.dlc ? `R${frame.dlc}` : 'R';
  else for (const byte of frame.data) body += hexByte(byte);
  return `(${seconds}.${micros}) can0 ${hexId(frame.id, frame.extended)}#${body}`;
}
