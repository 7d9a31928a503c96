// What came of an SDO transfer, in words.

import { decode } from '../codec';
import { address, otherSpelling, showValue } from '../format';
import type { Outcome } from '../can/sdo';
import { nodeId } from '../state';
import { T } from '../texts';
import type { ObjectRecord } from './api';
import { silence } from './client';
import { describe } from './link';
import { pack } from './packed';

export type Said = { tone: '' | 'error' | 'good'; text: string };

export async function inWords(object: ObjectRecord, outcome: Outcome): Promise<Said> {
  const where = address(object.index, object.sub);
  switch (outcome.kind) {
    case 'read': {
      const value = decode(outcome.bytes, object);
      const other = otherSpelling(value, object);
      return { tone: 'good', text: `${where} = ${showValue(value, object)}${other ? ` (${other})` : ''}` };
    }
    case 'written':
      return { tone: 'good', text: T.sdo.written(where) };
    case 'silent':
      return { tone: 'error', text: silence() };
    case 'aborted':
      return { tone: 'error', text: await abortWords(object.index, object.sub, outcome.code) };
  }
}

/** An abort as the console says it. */
export async function abortWords(index: number, sub: number, code: number): Promise<string> {
  const data = new Uint8Array(8);
  data.set([0x80, index & 255, index >> 8, sub]);
  new DataView(data.buffer).setUint32(4, code, true);
  const [words] = await describe(pack({ time: 0, id: 0x580 + nodeId.peek(), extended: false, remote: false, fromPage: false, data }));
  return words || T.sdo.aborted(code.toString(16).toUpperCase().padStart(8, '0'));
}
