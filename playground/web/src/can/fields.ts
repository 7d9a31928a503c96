// What the bytes of a frame are, one after the other: the fields of its service, and the
// objects that they stand for.

import type { ObjectRecord } from '../sim/api';
import type { Frame } from '../sim/packed';
import { classify } from './service';
import { address, decode, hexValue, showValue } from './values';

export interface Field {
  /** First byte and the one after the last. */
  from: number;
  to: number;
  name: string;
  value: string;
  /** The object that it stands for. */
  object?: { index: number; sub: number };
}

type Find = (index: number, sub: number) => ObjectRecord | undefined;

const uint = (data: Uint8Array, from: number, length: number): number => {
  let value = 0;
  for (let i = Math.min(length, data.length - from) - 1; i >= 0; i--) value = value * 256 + data[from + i]!;
  return value;
};
const hex = (value: number, digits: number): string => `${value.toString(16).toUpperCase().padStart(digits, '0')}h`;

const NMT: Record<number, string> = { 1: 'Start', 2: 'Stop', 0x80: 'Enter Pre-operational', 0x81: 'Reset node', 0x82: 'Reset communication' };
const STATES: Record<number, string> = { 0: 'boot-up', 4: 'Stopped', 5: 'Operational', 0x7f: 'Pre-operational' };
const REQUESTS = ['Download segment', 'Initiate download', 'Initiate upload', 'Upload segment', 'Abort', 'Block upload', 'Block download', '–'];
const ANSWERS = ['Upload segment', 'Download segment', 'Initiate upload', 'Initiate download', 'Abort', 'Block download', 'Block upload', '–'];

/** The fields of a frame; `layout` is the mapping of a PDO, as the worker tells it. */
export function fieldsOf(frame: Frame, find: Find, layout: Uint32Array): Field[] {
  const { data } = frame;
  if (frame.remote || frame.disturbed) return [];
  const { service } = classify(frame.id, frame.extended);
  if (layout.length) return pdo(data, find, layout);
  switch (service) {
    case 'NMT':
      return known(data, [[0, 1, 'Command', NMT[data[0] ?? -1] ?? 'unknown'], [1, 2, 'Node', data[1] ? String(data[1]) : 'all']]);
    case 'HB': {
      const state = (data[0] ?? 0) & 0x7f;
      return known(data, [[0, 1, 'State', `${STATES[state] ?? 'unknown'}${data[0]! & 0x80 ? ', toggle bit 1' : ''}`]]);
    }
    case 'EMCY':
      return known(data, [
        [0, 2, 'Error code', hex(uint(data, 0, 2), 4)],
        [2, 3, 'Error register 1001h', hex(data[2] ?? 0, 2), { index: 0x1001, sub: 0 }],
        [3, 8, 'Of the manufacturer', Array.from(data.subarray(3), (byte) => byte.toString(16).padStart(2, '0').toUpperCase()).join(' ')],
      ]);
    case 'SDO':
      return sdo(frame, find);
    case 'LSS':
      return known(data, [[0, 1, 'Command', `${data[0]} (${hex(data[0] ?? 0, 2)})`], [1, 5, 'Value', `${uint(data, 1, 4)} (${hex(uint(data, 1, 4), 8)})`]]);
    case 'SYNC':
      return known(data, [[0, 1, 'Counter', String(data[0])]]);
    default:
      return [];
  }
}

type Row = [from: number, to: number, name: string, value: string, object?: { index: number; sub: number }];

const known = (data: Uint8Array, rows: Row[]): Field[] =>
  rows.filter(([from]) => from < data.length).map(([from, to, name, value, object]) => ({ from, to: Math.min(to, data.length), name, value, ...(object ? { object } : {}) }));

function pdo(data: Uint8Array, find: Find, layout: Uint32Array): Field[] {
  const fields: Field[] = [];
  for (let i = 0; i + 2 < layout.length; i += 3) {
    const [key, first, bits] = [layout[i]!, layout[i + 1]!, layout[i + 2]!];
    const [index, sub] = [key >> 8, key & 255];
    const from = first >> 3;
    const to = (first + bits + 7) >> 3;
    if (to > data.length) break;
    const object = find(index, sub);
    const bytes = data.slice(from, to);
    const value = object && first % 8 === 0 ? showValue(decode(bytes, object), object) : hexValue(uint(data, from, to - from), bits);
    fields.push({ from, to, name: object?.name ?? address(index, sub), value, object: { index, sub } });
  }
  return fields;
}

function sdo({ id, data }: Frame, find: Find): Field[] {
  const command = data[0] ?? 0;
  const isAnswer = id < 0x600;
  const kind = command >> 5;
  const name = (isAnswer ? ANSWERS : REQUESTS)[kind]!;
  // Segments carry no address, initiations and aborts do.
  const hasAddress = kind === 4 || (isAnswer ? kind === 2 || kind === 3 : kind === 1 || kind === 2) || (kind >= 5 && data.length >= 4 && (data[1]! | (data[2]! << 8)) >= 0x1000);
  if (!hasAddress) return known(data, [[0, 1, 'Command', name], [1, 8, 'Data', Array.from(data.subarray(1), (byte) => byte.toString(16).padStart(2, '0').toUpperCase()).join(' ')]]);
  const [index, sub] = [uint(data, 1, 2), data[3] ?? 0];
  const object = find(index, sub);
  const where = { index, sub };
  const rows: Row[] = [[0, 1, 'Command', name], [1, 3, 'Index', `${hex(index, 4)}${object ? ` ${object.parent ?? object.name}` : ''}`, where], [3, 4, 'Sub-index', `${sub}${object?.parent ? ` ${object.name}` : ''}`, where]];
  const isExpedited = (command & 2) !== 0 && (isAnswer ? kind === 2 : kind === 1);
  if (kind === 4) rows.push([4, 8, 'Abort code', hex(uint(data, 4, 4), 8)]);
  else if (isExpedited) {
    const length = command & 1 ? 4 - ((command >> 2) & 3) : Math.min(4, object?.bits ? object.bits / 8 : 4);
    const bytes = data.slice(4, 4 + length);
    rows.push([4, 4 + length, 'Data', object ? showValue(decode(bytes, object), object) : `${uint(data, 4, length)} (${hex(uint(data, 4, length), length * 2)})`, where]);
  } else if (command & 1 && (isAnswer ? kind === 2 : kind === 1)) rows.push([4, 8, 'Length', `${uint(data, 4, 4)} bytes`]);
  return known(data, rows);
}
