// Condition of a trigger: a frame that passes a filter, or an object with a value:
// `6004 > 1000`, `node:2 6041:0 = 0x37`, `6004 changes`.

import { address } from '../format';
import { parseFilter, type Filter } from '../trace/filter';
import { S } from './texts';

const COMPARE = {
  '=': (value: number, than: number) => value === than,
  '!=': (value: number, than: number) => value !== than,
  '<': (value: number, than: number) => value < than,
  '<=': (value: number, than: number) => value <= than,
  '>': (value: number, than: number) => value > than,
  '>=': (value: number, than: number) => value >= than,
};

export interface ObjectCondition {
  /** Node ID; null: any node. */
  node: number | null;
  index: number;
  sub: number;
  /** In words: `6004h > 1000`. */
  text: string;
  /** Returns whether it holds for a value, given the value before. */
  holds(value: number, before: number | null): boolean;
}

export type Condition = { filter: Filter } | { object: ObjectCondition };

const OBJECT = /^\s*(?:node:(\d{1,3})\s+)?(?:0x)?([0-9a-f]{4})h?(?:[:.](?:0x)?([0-9a-f]{1,2})h?)?\s*(?:(changes)|(==|=|!=|<=|>=|<|>)\s*(.*?))\s*$/i;

/** A number in decimal or hexadecimal (`0x1F`, `1Fh`), or with a fraction. */
function numberOf(text: string): number | null {
  const hex = /^(-?)(?:0x([0-9a-f]+)|([0-9a-f]+)h)$/i.exec(text);
  if (hex) return Number.parseInt(`${hex[1]}${hex[2] ?? hex[3]}`, 16);
  return /^[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?$/i.test(text) ? Number(text) : null;
}

/** Parses a condition; returns the error and its place if it is not valid. */
export function parseCondition(text: string): Condition | { error: string; at: number } {
  const match = OBJECT.exec(text);
  if (!match) {
    const parsed = parseFilter(text);
    if ('error' in parsed) return parsed;
    return parsed.filter ? { filter: parsed.filter } : { error: S.trigger.empty, at: 0 };
  }
  const [, nodeText, index, sub, changes, sign, value] = match;
  const node = nodeText === undefined ? null : Number(nodeText);
  if (node !== null && (node < 1 || node > 127)) return { error: S.trigger.node, at: text.indexOf(nodeText!) };
  const where = { node, index: Number.parseInt(index!, 16), sub: Number.parseInt(sub ?? '0', 16) };
  const name = `${address(where.index, where.sub)}${node === null ? '' : ` ${S.trigger.of(node)}`}`;
  if (changes) return { object: { ...where, text: S.trigger.changes(name), holds: (now, before) => before !== null && now !== before } };
  const than = numberOf(value!);
  if (than === null) return { error: S.trigger.number, at: text.length - value!.length };
  const compare = COMPARE[(sign === '==' ? '=' : sign) as keyof typeof COMPARE];
  return { object: { ...where, text: `${name} ${sign} ${value}`, holds: (now) => compare(now, than) } };
}
