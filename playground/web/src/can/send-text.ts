// What a row of the send list says: a frame, or something with a name that becomes one.
// `601#40 04 60 00`, `read 6004`, `write 6001 = 4096`, `nmt start 5`, `sync`, `guard`.

import type { ObjectRecord } from '../sim/api';
import { parseAddress } from '../views/object-search';
import { T } from '../texts';
import { parseFrame, type Typed } from './text';
import { encode } from './values';

export type ParsedSend = { frame: Typed } | { error: string };

interface Target {
  nodeId: number;
  object(index: number, sub: number): ObjectRecord | undefined;
}

const NMT: Record<string, number> = { start: 1, stop: 2, preop: 0x80, reset: 0x81, 'reset-comm': 0x82 };

const frame = (id: number, bytes: number[]): ParsedSend => ({ frame: { id, extended: false, remote: false, data: Uint8Array.from(bytes), dlc: bytes.length } });

export function parseSend(text: string, target: Target): ParsedSend {
  const [word = '', ...rest] = text.trim().split(/\s+/);
  switch (word.toLowerCase()) {
    case 'sync':
      return frame(0x80, rest[0] ? [Number(rest[0]) & 255] : []);
    case 'guard':
      return { frame: { id: 0x700 + target.nodeId, extended: false, remote: true, data: new Uint8Array(0), dlc: 1 } };
    case 'nmt': {
      const command = NMT[(rest[0] ?? '').toLowerCase()];
      if (command === undefined) return { error: T.typed.nmt };
      const node = rest[1] === 'all' ? 0 : rest[1] === undefined ? target.nodeId : Number(rest[1]);
      return Number.isInteger(node) && node >= 0 && node <= 127 ? frame(0, [command, node]) : { error: T.typed.node };
    }
    case 'read':
    case 'write':
      return sdo(word.toLowerCase() === 'write', rest.join(' '), target);
    default: {
      const parsed = parseFrame(text);
      return 'frame' in parsed ? { frame: parsed.frame } : { error: parsed.error };
    }
  }
}

function sdo(isWrite: boolean, text: string, { nodeId, object }: Target): ParsedSend {
  const [where = '', ...value] = text.split('=');
  const address = parseAddress(where);
  if (!address) return { error: T.typed.object };
  const { index, sub } = address;
  const head = [index & 255, index >> 8, sub];
  if (!isWrite) return frame(0x600 + nodeId, [0x40, ...head, 0, 0, 0, 0]);
  const known = object(index, sub);
  if (!known) return { error: T.typed.noObject };
  const encoded = encode(value.join('='), known);
  if ('error' in encoded) return { error: encoded.error };
  const { bytes } = encoded;
  if (bytes.length === 0 || bytes.length > 4) return { error: T.typed.long };
  return frame(0x600 + nodeId, [0x23 | ((4 - bytes.length) << 2), ...head, ...bytes, ...new Array<number>(4 - bytes.length).fill(0)]);
}
