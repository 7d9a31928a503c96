// The capture in the formats of other tools.

import { candumpLine, hexByte, hexId } from '../can/text';
import type { Frame } from '../sim/packed';

export type Format = 'log' | 'asc' | 'trc' | 'pcapng';

/** The text or the bytes of a file. */
export function write(format: Format, frames: Iterable<Frame>): string | Uint8Array<ArrayBuffer> {
  switch (format) {
    case 'log':
      return candump(frames);
    case 'asc':
      return asc(frames);
    case 'trc':
      return trc(frames);
    case 'pcapng':
      return pcapng(frames);
  }
}

const bytes = (frame: Frame): string => Array.from(frame.data, hexByte).join(' ');

/** `candump -L`; what was disturbed on the wire is an error frame of SocketCAN. */
function candump(frames: Iterable<Frame>): string {
  let text = '';
  for (const frame of frames) {
    const time = `(${Math.floor(frame.time / 1e6)}.${String(Math.floor(frame.time % 1e6)).padStart(6, '0')})`;
    text += frame.disturbed ? `${time} can0 20000008#0000040000000000\n` : `${candumpLine(frame)}\n`;
  }
  return text;
}

/** Vector ASC. */
function asc(frames: Iterable<Frame>): string {
  const lines = ['date Thu Jan 1 12:00:00.000 am 1970', 'base hex  timestamps absolute', 'internal events logged', 'Begin Triggerblock Thu Jan 1 12:00:00.000 am 1970', '   0.000000 Start of measurement'];
  for (const frame of frames) {
    const time = (frame.time / 1e6).toFixed(6).padStart(11);
    if (frame.disturbed) {
      lines.push(`${time} 1  ErrorFrame`);
      continue;
    }
    const id = `${frame.id.toString(16).toUpperCase()}${frame.extended ? 'x' : ''}`.padEnd(15);
    const dir = (frame.fromPage ? 'Tx' : 'Rx').padEnd(4);
    lines.push(`${time} 1  ${id} ${dir} ${frame.remote ? `r ${frame.dlc}` : `d ${frame.dlc}${frame.data.length ? ` ${bytes(frame)}` : ''}`}`);
  }
  lines.push('End TriggerBlock');
  return `${lines.join('\n')}\n`;
}

/** PEAK TRC, version 2.1. */
function trc(frames: Iterable<Frame>): string {
  const lines = [';$FILEVERSION=2.1', ';$STARTTIME=25569.0000000000', ';$COLUMNS=N,O,T,B,I,d,R,L,D', ';', ';   Message   Time    Type    ID     Rx/Tx', ';   Number    Offset  |  Bus  [hex]  |  Reserved', ';   |         [ms]    |  |    |      |  |  Data Length', ';---+-- ------+------ +- +- --+----- +- +- +--- +- -- -- -- -- -- -- --'];
  let number = 0;
  for (const frame of frames) {
    number += 1;
    const head = `${String(number).padStart(7)} ${(frame.time / 1000).toFixed(3).padStart(13)}`;
    if (frame.disturbed) {
      lines.push(`${head} ER 1         - Rx -  5    04 00 08 00 00`);
      continue;
    }
    const id = hexId(frame.id, frame.extended).padStart(frame.extended ? 8 : 4, '0').padStart(9);
    lines.push(`${head} ${frame.remote ? 'RR' : 'DT'} 1 ${id} ${frame.fromPage ? 'Tx' : 'Rx'} -  ${frame.dlc}${frame.data.length ? `    ${bytes(frame)}` : ''}`);
  }
  return `${lines.join('\r\n')}\r\n`;
}

/** pcapng with frames of SocketCAN (link type 227), times in microseconds. */
function pcapng(frames: Iterable<Frame>): Uint8Array<ArrayBuffer> {
  const LINK = 227;
  const list = [...frames];
  const blocks = list.map((frame) => 32 + padded(8 + body(frame).length));
  const out = new Uint8Array(28 + 20 + blocks.reduce((sum, size) => sum + size, 0));
  const view = new DataView(out.buffer);
  const u32 = (at: number, value: number): void => view.setUint32(at, value, true);
  // Section header, then one interface.
  u32(0, 0x0a0d0d0a);
  u32(4, 28);
  u32(8, 0x1a2b3c4d);
  view.setUint16(12, 1, true);
  u32(16, 0xffffffff);
  u32(20, 0xffffffff);
  u32(24, 28);
  u32(28, 1);
  u32(32, 20);
  view.setUint16(36, LINK, true);
  u32(44, 20);
  let at = 48;
  list.forEach((frame, i) => {
    const size = blocks[i]!;
    const data = body(frame);
    u32(at, 6);
    u32(at + 4, size);
    const time = Math.round(frame.time);
    u32(at + 12, Math.floor(time / 2 ** 32));
    u32(at + 16, time % 2 ** 32);
    u32(at + 20, 8 + data.length);
    u32(at + 24, 8 + data.length);
    // The identifier is big-endian, with its flags on top.
    const flags = frame.disturbed ? 0x20000008 : (frame.extended ? 0x80000000 : 0) + (frame.remote ? 0x40000000 : 0) + frame.id;
    view.setUint32(at + 28, flags >>> 0, false);
    out[at + 32] = frame.disturbed ? 8 : frame.dlc;
    out.set(data, at + 36);
    u32(at + size - 4, size);
    at += size;
  });
  return out;
}

const padded = (length: number): number => (length + 3) & ~3;

/** The data of a frame in a capture; a remote one has none, an error frame eight bytes. */
function body(frame: Frame): Uint8Array {
  return frame.disturbed ? Uint8Array.of(0, 0, 4, 0, 0, 0, 0, 0) : frame.data;
}
