// Logs of other tools as frames: candump, ASC, TRC, pcap and pcapng. What cannot be read
// is counted, and the first of it named.

import { pack, type Frame } from '../sim/packed';
import { DISTURBED } from '../sim/packed';

export interface Log {
  /** Packed, in the order of their times, which begin at 0. */
  frames: Uint8Array;
  count: number;
  /** Lines that could not be read. */
  skipped: number;
  /** The first of them, from 1, and why. */
  firstSkipped: { line: number; why: string } | null;
}

type Read = Omit<Frame, 'dlc' | 'device' | 'disturbed'> & { dlc: number; disturbed: boolean };

/** Reads a log, whatever it is. Throws an Error with the reason where it is none. */
export function read(bytes: Uint8Array): Log {
  if (bytes.length >= 4) {
    const magic = new DataView(bytes.buffer, bytes.byteOffset, bytes.length).getUint32(0, true);
    if (magic === 0x0a0d0d0a) return finish(pcapng(bytes), []);
    if ([0xa1b2c3d4, 0xd4c3b2a1, 0xa1b23c4d, 0x4d3cb2a1].includes(magic)) return finish(pcap(bytes), []);
  }
  const text = new TextDecoder('utf-8').decode(bytes).replace(/^\ufeff/, '');
  const lines = text.split(/\r\n|\r|\n/);
  const reader = choose(lines);
  if (!reader) throw new Error('it is neither a candump log nor ASC, TRC, pcap or pcapng');
  const skipped: { line: number; why: string }[] = [];
  const frames: Read[] = [];
  lines.forEach((line, i) => {
    if (!line.trim()) return;
    const frame = reader(line);
    if (typeof frame === 'string') skipped.push({ line: i + 1, why: frame });
    else if (frame) frames.push(frame);
  });
  if (frames.length === 0 && skipped[0]) throw new Error(`line ${skipped[0].line}: ${skipped[0].why}`);
  return finish(frames, skipped);
}

function finish(frames: Read[], skipped: { line: number; why: string }[]): Log {
  frames.sort((a, b) => a.time - b.time);
  const start = frames[0]?.time ?? 0;
  // Clocks of the day are taken off; a log that begins near 0 keeps its times.
  const shift = start > 1e12 ? start : 0;
  const packed = new Uint8Array(frames.length * 24);
  frames.forEach((frame, i) => {
    const one = pack({ ...frame, time: frame.time - shift });
    if (frame.disturbed) one[12]! |= DISTURBED;
    packed.set(one, i * 24);
  });
  return { frames: packed, count: frames.length, skipped: skipped.length, firstSkipped: skipped[0] ?? null };
}

/** One line: a frame, nothing (a comment, a header), or what is wrong with it. */
type Reader = (line: string) => Read | null | string;

function choose(lines: string[]): Reader | null {
  const head = lines.slice(0, 200);
  if (head.some((line) => /^;\$(FILEVERSION|STARTTIME)/i.test(line)) || head.some((line) => /^\s*\d+\)\s+[\d.]+\s/.test(line))) return trcReader(lines);
  if (head.some((line) => /^\s*(date\s|base\s+(hex|dec))/i.test(line))) return ascReader(lines);
  if (head.some((line) => /^\s*\([\d.]+\)\s+\S+\s/.test(line))) return candumpLine;
  return null;
}

const hexBytes = (text: string): number[] | null => {
  const digits = text.replace(/\s+/g, '');
  if (!/^([0-9a-f]{2})*$/i.test(digits)) return null;
  return (digits.match(/../g) ?? []).map((pair) => Number.parseInt(pair, 16));
};

const make = (time: number, id: number, extended: boolean, data: number[], more: Partial<Read> = {}): Read => ({
  time: Math.round(time), id, extended, remote: false, fromPage: false, disturbed: false, dlc: data.length, data: Uint8Array.from(data), ...more,
});

const trouble = (time: number): Read => make(time, 0, false, [0, 0, 0, 0, 0, 0], { disturbed: true });

/** `(1.000000) can0 601#4004…`, `(1.0) can0 701#R`, and what the screen shows: `(1.0) can0 601 [8] 40 04`. */
function candumpLine(line: string): Read | null | string {
  if (/^\s*[#;]/.test(line)) return null;
  const match = /^\s*\((\d+(?:\.\d+)?)\)\s+\S+\s+(.*?)\s*$/.exec(line);
  if (!match) return 'no time stamp in parentheses';
  const time = Number(match[1]) * 1e6;
  const compact = /^([0-9a-f]{3}|[0-9a-f]{8})#(R\d?|[0-9a-f.]*)(?:\s+([RT]))?$/i.exec(match[2]!);
  const screen = /^(?:RX|TX)?\s*-*\s*([0-9a-f]{3}|[0-9a-f]{8})\s+\[(\d)\]\s*(remote request|[0-9a-f\s]*)/i.exec(match[2]!);
  if (!compact && !screen) return /##/.test(match[2]!) ? 'CAN FD is not CANopen' : 'no frame such as 601#4004600000000000';
  const [, digits, body = ''] = (compact ?? [screen![0], screen![1], screen![3]]) as string[];
  const raw = Number.parseInt(digits!, 16);
  const isExtended = digits!.length === 8;
  if (isExtended && raw & 0x20000000) return trouble(time);
  if (raw > (isExtended ? 0x1fffffff : 0x7ff)) return `the identifier ${digits} is too large`;
  const fromPage = compact?.[3]?.toUpperCase() === 'T';
  if (/^r/i.test(body)) return make(time, raw, isExtended, [], { remote: true, fromPage, dlc: screen ? Number(screen[2]) : Number(body.slice(1)) || 0 });
  const data = hexBytes(body.replaceAll('.', ''));
  if (!data || data.length > 8) return 'the data are not up to eight hexadecimal bytes';
  return make(time, raw, isExtended, data, { fromPage });
}

function ascReader(lines: string[]): Reader {
  const base = lines.find((line) => /^\s*base\s/i.test(line)) ?? '';
  const radix = /base\s+dec/i.test(base) ? 10 : 16;
  const isRelative = /timestamps\s+relative/i.test(base);
  let last = 0;
  return (line) => {
    if (/^\s*(\/\/|date\s|base\s|(no\s+)?internal\s|begin\s|end\s)/i.test(line)) return null;
    const match = /^\s*(\d+\.\d+)\s+(.*)$/.exec(line);
    if (!match) return 'no time stamp';
    const time = (isRelative ? last : 0) + Number(match[1]) * 1e6;
    last = time;
    const rest = match[2]!;
    if (/^start of measurement|^canfd\b|^log |^can \d+ status|statistic:|^\d+\s+(statistic|j1939)|^trigger|^comment/i.test(rest)) return null;
    if (/^\d+\s+ErrorFrame/i.test(rest)) return trouble(time);
    const frame = /^\d+\s+([0-9a-f]+)(x?)\s+(Rx|Tx)\s+([dr])\s*([0-9a-f])?(.*)$/i.exec(rest);
    if (!frame) return 'no frame such as “1  601  Rx  d 8 40 04 …”';
    const id = Number.parseInt(frame[1]!, radix);
    const extended = frame[2] !== '';
    if (id > (extended ? 0x1fffffff : 0x7ff)) return `the identifier ${frame[1]} is too large`;
    const fromPage = frame[3]!.toLowerCase() === 'tx';
    const dlc = Number.parseInt(frame[5] ?? '0', 16);
    if (frame[4]!.toLowerCase() === 'r') return make(time, id, extended, [], { remote: true, fromPage, dlc: Math.min(8, dlc) });
    const words = frame[6]!.trim().split(/\s+/).filter(Boolean).slice(0, Math.min(8, dlc));
    const data = words.map((word) => Number.parseInt(word, radix));
    if (data.length < Math.min(8, dlc) || data.some((byte) => !(byte >= 0 && byte <= 255))) return `the data are not ${dlc} bytes`;
    return make(time, id, extended, data, { fromPage });
  };
}

/** PEAK TRC 1.0 to 1.3 and 2.0, 2.1. */
function trcReader(lines: string[]): Reader {
  const version = /^;\$FILEVERSION=(\d)\.(\d)/i.exec(lines.find((line) => /^;\$FILEVERSION/i.test(line)) ?? '');
  if (version?.[1] === '2') return trc2(lines);
  const hasBus = version?.[2] === '2' || version?.[2] === '3';
  const hasReserved = version?.[2] === '3';
  return (line) => {
    if (/^\s*;/.test(line)) return null;
    const match = /^\s*\d+\)\s+(\d+(?:\.\d+)?)\s+(.*)$/.exec(line);
    if (!match) return 'no message number and time';
    const words = match[2]!.trim().split(/\s+/);
    if (hasBus) words.shift();
    // Version 1.0 has no direction.
    const type = /^(rx|tx|warng|error)/i.test(words[0] ?? '') ? words.shift()! : 'Rx';
    const time = Number(match[1]) * 1000;
    if (/^error/i.test(type)) return trouble(time);
    if (/^warng/i.test(type)) return null;
    const id = words.shift() ?? '';
    if (/^f{4,8}$/i.test(id) && /^0*4$/.test(words[0] ?? '') && !version) return null;
    if (hasReserved) words.shift();
    return peak(time, id, words, /^tx/i.test(type), words[1]?.toUpperCase() === 'RTR');
  };
}

function trc2(lines: string[]): Reader {
  const given = /^;\$COLUMNS=(.*)$/i.exec(lines.find((line) => /^;\$COLUMNS/i.test(line)) ?? '')?.[1];
  const columns = (given ?? 'N,O,T,I,d,l,D').split(',').map((name) => name.trim());
  return (line) => {
    if (/^\s*;/.test(line)) return null;
    const words = line.trim().split(/\s+/);
    const field = (name: string): string => words[columns.indexOf(name)] ?? '';
    const time = Number(field('O')) * 1000;
    if (!Number.isFinite(time) || field('O') === '') return 'no time offset';
    const type = field('T');
    if (type === 'ER') return trouble(time);
    if (type !== 'DT' && type !== 'RR') return /^F[DBE]$|^BI$/.test(type) ? 'CAN FD is not CANopen' : /^(ST|EC|EV)$/.test(type) ? null : `“${type}” is no type of message`;
    const data = columns.indexOf('D');
    const length = columns.includes('L') ? field('L') : field('l');
    return peak(time, field('I'), [length, ...(data >= 0 ? words.slice(data) : [])], /^tx/i.test(field('d')), type === 'RR');
  };
}

/** The part that all versions share: identifier, length, bytes. */
function peak(time: number, digits: string, words: string[], fromPage: boolean, remote: boolean): Read | string {
  if (!/^[0-9a-f]{3,8}$/i.test(digits)) return `“${digits}” is no identifier`;
  const id = Number.parseInt(digits, 16);
  const extended = digits.length > 4;
  if (id > (extended ? 0x1fffffff : 0x7ff)) return `the identifier ${digits} is too large`;
  const dlc = Number(words[0]);
  if (!(dlc >= 0 && dlc <= 8)) return `“${words[0] ?? ''}” is no length`;
  if (remote) return make(time, id, extended, [], { remote: true, fromPage, dlc });
  const data = hexBytes(words.slice(1, 1 + dlc).join(''));
  if (!data || data.length !== dlc) return `the data are not ${dlc} bytes`;
  return make(time, id, extended, data, { fromPage });
}

const LINK_SOCKETCAN = 227;

/** One frame of SocketCAN in a capture. */
function socketcan(time: number, bytes: Uint8Array): Read | null {
  if (bytes.length < 8) return null;
  const raw = new DataView(bytes.buffer, bytes.byteOffset, bytes.length).getUint32(0, false);
  if (raw & 0x20000000) return trouble(time);
  const extended = raw >= 0x80000000;
  const dlc = Math.min(8, bytes[4]!);
  const id = raw & (extended ? 0x1fffffff : 0x7ff);
  if (raw & 0x40000000) return make(time, id, extended, [], { remote: true, dlc });
  return make(time, id, extended, [...bytes.subarray(8, 8 + dlc)], {});
}

function pcap(bytes: Uint8Array): Read[] {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
  const magic = view.getUint32(0, true);
  const little = magic === 0xa1b2c3d4 || magic === 0xa1b23c4d;
  const nanos = view.getUint32(0, little) === 0xa1b23c4d;
  if (bytes.length < 24 || (view.getUint32(20, little) & 0xffff) !== LINK_SOCKETCAN) throw new Error('its frames are not of SocketCAN (link type 227)');
  const frames: Read[] = [];
  for (let at = 24; at + 16 <= bytes.length; ) {
    const length = view.getUint32(at + 8, little);
    if (at + 16 + length > bytes.length) throw new Error(`it ends in the middle of a frame, at byte ${at}`);
    const time = view.getUint32(at, little) * 1e6 + view.getUint32(at + 4, little) / (nanos ? 1000 : 1);
    const frame = socketcan(time, bytes.subarray(at + 16, at + 16 + length));
    if (frame) frames.push(frame);
    at += 16 + length;
  }
  return frames;
}

function pcapng(bytes: Uint8Array): Read[] {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
  let little = true;
  let interfaces: { link: number; unit: number }[] = [];
  const frames: Read[] = [];
  let others = 0;
  for (let at = 0; at + 12 <= bytes.length; ) {
    const type = view.getUint32(at, little);
    if (type === 0x0a0d0d0a) {
      little = view.getUint32(at + 8, true) === 0x1a2b3c4d;
      interfaces = [];
    }
    const size = view.getUint32(at + 4, little);
    if (size < 12 || size % 4 || at + size > bytes.length) throw new Error(`it ends in the middle of a block, at byte ${at}`);
    if (type === 1) interfaces.push({ link: view.getUint16(at + 8, little), unit: resolution(view, at + 16, at + size - 4, little) });
    if (type === 6) {
      const owner = interfaces[view.getUint32(at + 8, little)];
      const length = Math.min(view.getUint32(at + 20, little), size - 32);
      if (owner?.link === LINK_SOCKETCAN) {
        const ticks = view.getUint32(at + 12, little) * 2 ** 32 + view.getUint32(at + 16, little);
        const frame = socketcan(ticks * owner.unit * 1e6, bytes.subarray(at + 28, at + 28 + length));
        if (frame) frames.push(frame);
      } else others += 1;
    }
    at += size;
  }
  if (frames.length === 0 && others > 0) throw new Error('its frames are not of SocketCAN (link type 227)');
  return frames;
}

/** Seconds of one tick: the option if_tsresol, else a microsecond. */
function resolution(view: DataView, from: number, to: number, little: boolean): number {
  for (let at = from; at + 4 <= to; ) {
    const [code, length] = [view.getUint16(at, little), view.getUint16(at + 2, little)];
    if (code === 9 && length >= 1) {
      const value = view.getUint8(at + 4);
      return value & 0x80 ? 2 ** -(value & 0x7f) : 10 ** -value;
    }
    if (code === 0) break;
    at += 4 + ((length + 3) & ~3);
  }
  return 1e-6;
}
