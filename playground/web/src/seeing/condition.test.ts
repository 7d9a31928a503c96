import { assert, test } from '../testing';
import { parseCondition } from './condition';

const of = (text: string) => {
  const parsed = parseCondition(text);
  if (!('object' in parsed)) throw new Error(`${text} is about no object`);
  return parsed.object;
};

test('an object is compared with a number', () => {
  for (const [text, value, holds] of [
    ['6004 > 1000', 1001, true],
    ['6004>1000', 1000, false],
    ['0x6004h >= 1000', 1000, true],
    ['6041:0 = 0x37', 55, true],
    ['6041:00 == 37h', 55, true],
    ['6030:1 <= -5', -6, true],
    ['6030:1 < -5', -5, false],
    ['1001 != 0', 0, false],
    ['1001 != 0', 1, true],
    ['7320.1 > 0.5', 0.6, true],
  ] as const) assert.equal(of(text).holds(value, null), holds, `${text}: ${value}`);
  assert.deepEqual([of('node:12 6030:0A = 1').node, of('node:12 6030:0A = 1').index, of('6030:0A = 1').sub, of('6004 = 1').node], [12, 0x6030, 10, null]);
  assert.equal(of('node:2 6004 > 5').text, '6004h of node 2 > 5');
});

test('a change needs a value before', () => {
  const { holds } = of('6004 changes');
  assert.deepEqual([holds(1, null), holds(1, 1), holds(2, 1)], [false, false, true]);
});

test('anything else is a filter of the console', () => {
  for (const text of ['node:5 sdo', '6004', 'emcy or abort', 'canopen.cob_id == 0x181']) assert.ok('filter' in parseCondition(text), text);
});

test('mistakes say where', () => {
  for (const [text, at, error] of [
    ['', 0, /Write/],
    ['6004 > x', 7, /number/],
    ['6004 >', 6, /number/],
    ['node:200 6004 > 1', 5, /1 to 127/],
    ['nod:5', 0, /not a field/],
  ] as const) {
    const parsed = parseCondition(text);
    if (!('error' in parsed)) throw new Error(`${text} should not be read`);
    assert.match(parsed.error, error, text);
    assert.equal(parsed.at, at, text);
  }
});
