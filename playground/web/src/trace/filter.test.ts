import { assert, test } from '../testing';
import { parseFilter } from './filter';
import { pack, type Packed } from '../sim/packed';
import { Ring, type Frame } from './ring';

function frame(id: number, bytes: number[], more: Partial<Packed> = {}): Frame {
  const ring = new Ring();
  ring.append(pack({ time: 0, id, extended: false, remote: false, fromPage: false, device: 1, data: Uint8Array.from(bytes), ...more }));
  return ring.get(0)!;
}

const passes = (text: string, one: Frame, words?: string): boolean => {
  const parsed = parseFilter(text);
  if ('error' in parsed) throw new Error(`${text}: ${parsed.error}`);
  return parsed.filter ? parsed.filter.test(one, words) : true;
};

const answer = frame(0x585, [0x43, 0x04, 0x60, 0, 1, 2, 3, 4]);
const pdo = frame(0x181, [1, 2, 3, 4]);
const heartbeat = frame(0x705, [5]);

test('services, nodes, identifiers', () => {
  for (const [text, expected] of [
    ['', [true, true, true]],
    ['sdo', [true, false, false]],
    ['node:5', [true, false, true]],
    ['node:5 sdo', [true, false, false]],
    ['181', [false, true, false]],
    ['id:0x181', [false, true, false]],
    ['canopen.cob_id == 0x181', [false, true, false]],
    ['canopen.cob_id!=181', [true, false, true]],
    ['180:780', [false, true, false]],
    ['185:7FF', [false, false, false]],
    ['180-5FF', [true, true, false]],
    ['!hb', [true, true, false]],
    ['-hb -sdo', [false, true, false]],
    ['not (sdo or hb)', [false, true, false]],
    ['pdo | node:5 hb', [false, true, true]],
    ['6004', [true, false, false]],
    ['object:6004:00', [true, false, false]],
    ['object:6004:01', [false, false, false]],
    ['data:43..60', [true, false, false]],
    ['data:"01 02"', [false, true, false]],
    ['pdo1', [false, true, false]],
    ['len:4', [false, true, false]],
    ['rx !tx', [true, true, true]],
    ['abort', [false, false, false]],
  ] as const) {
    assert.deepEqual([answer, pdo, heartbeat].map((one) => passes(text, one)), expected, text);
  }
});

test('CAN-IDs with h, of 29 bits, and in lists', () => {
  const extended = frame(0x18ff50e5, [1], { extended: true });
  for (const [text, expected] of [
    ['181h', [false, true, false, false]],
    ['18FF50E5', [false, false, false, true]],
    ['0x18ff50e5', [false, false, false, true]],
    ['id:18FF50E5h', [false, false, false, true]],
    ['00000181', [false, false, false, false]],
    ['181,705', [false, true, true, false]],
    ['id:181h,585h', [true, true, false, false]],
    ['sdo,hb', [true, false, true, false]],
    ['!181,705', [true, false, false, true]],
    ['180-18F,700:780', [false, true, true, false]],
    ['181h,29-bit', [false, true, false, true]],
    ['11bit hb', [false, false, true, false]],
  ] as const) {
    assert.deepEqual([answer, pdo, heartbeat, extended].map((one) => passes(text, one)), expected, text);
  }
});

test('a number that is neither is an error', () => {
  for (const text of ['181x', '1G', '5..', '123456789', 'id:2FFFFFFF']) assert.ok('error' in parseFilter(text), text);
});

test('words', () => {
  assert.ok(passes('position', pdo, 'TPDO1 Position value = 5'));
  assert.ok(!passes('position', pdo, 'Heartbeat'));
  assert.ok(!passes('!position', pdo, 'TPDO1 Position value = 5'));
  assert.ok(passes('"position value" pdo', pdo, 'TPDO1 Position value = 5'));
  assert.ok(passes('position', pdo), 'unknown words let it pass');
  assert.ok(passes('!position', pdo), 'unknown words let it pass');
  const parsed = parseFilter('sdo !position');
  assert.ok('filter' in parsed && parsed.filter!.needsWords);
});

test('mistakes say where', () => {
  for (const [text, at, error] of [
    ['node:200', 5, /1 to 127/],
    ['node:', 5, /missing/],
    ['nod:5', 0, /not a field/],
    ['sdo (pdo', 4, /not closed/],
    ['sdo)', 3, /open/],
    ['sdo or', 6, /missing/],
    ['"posi', 0, /not closed/],
    ['id:zz', 3, /hexadecimal/],
    ['data:4', 5, /two hexadecimal/],
    ['5FF-180', 0, /before it begins/],
    ['!', 1, /missing/],
  ] as const) {
    const parsed = parseFilter(text);
    if (!('error' in parsed)) throw new Error(`${text} should not be read`);
    assert.match(parsed.error, error, text);
    assert.equal(parsed.at, at, text);
  }
});
