// Reads and writes objects over the bus, and describes the result in words.

import { decode } from '../codec';
import { address, otherSpelling, showValue } from '../format';
import { said } from '../language';
import { nodeId, powered } from '../state';
import { T } from '../texts';
import type { Address, ObjectRecord, Outcome } from './api';
import { ask, hooks, maySend } from './link';

export type Message = { tone: '' | 'error' | 'good'; text: string };

/** No node responded. */
const SILENT: Outcome = { job: 0, kind: 'silent', bytes: null, words: '', wantsPdoOff: false };

/** Reads an object of the selected node over the bus, or writes it if there are bytes. */
export const transfer = ({ index, sub }: Address, bytes: Uint8Array | null): Promise<Outcome> =>
  maySend() ? ask((ticket) => ({ op: 'transfer', ticket, node: nodeId.value, index, sub, bytes }), SILENT) : (hooks.held(), Promise.resolve({ ...SILENT, words: T.sdo.held }));

/** Reason why no value was read. */
export const failure = ({ words }: Outcome): string => said(words) || (powered.value ? T.sdo.stopped : T.sdo.off);

export function inWords(object: ObjectRecord, isWrite: boolean, outcome: Outcome): Message {
  const where = address(object.index, object.sub);
  if (outcome.bytes === null) return { tone: 'error', text: failure(outcome) };
  if (isWrite) return { tone: 'good', text: T.sdo.written(where) };
  const value = decode(outcome.bytes, object);
  const other = otherSpelling(value, object);
  return { tone: 'good', text: `${where} = ${showValue(value, object)}${other ? ` (${other})` : ''}` };
}
