import type { ObjectRecord } from '../sim/api';
import { address, decode, encode, range, showValue } from './values';
import { assert, test } from '../testing';

const object = (type: string, bits: number, more: Partial<ObjectRecord> = {}): ObjectRecord => ({
  index: 0x2000, sub: 0, name: 'Thing', parent: null, type, bits, access: 'rw', mappable: false, default: null, low: null, high: null, ...more,
});

const bytes = (text: string, of: ObjectRecord): string => {
  const encoded = encode(text, of);
  return 'error' in encoded ? `! ${encoded.error}` : Array.from(encoded.bytes, (byte) => byte.toString(16).padStart(2, '0')).join('');
};

test('integers in every spelling', () => {
  const u32 = object('UNSIGNED32', 32);
  for (const text of ['4096', '0x1000', '1000h', ' 4 096 ', '4_096', '4,096', '4\u2009096']) assert.equal(bytes(text, u32), '00100000', text);
  assert.equal(bytes('"save"', u32), '73617665');
  assert.equal(bytes('-1', object('INTEGER16', 16)), 'ffff');
  assert.equal(bytes('0xFFFF', object('INTEGER16', 16)), 'ffff');
  assert.equal(bytes('18446744073709551615', object('UNSIGNED64', 64)), 'ffffffffffffffff');
  assert.equal(bytes('true', object('BOOLEAN', 1)), '01');
});

test('what does not fit is refused', () => {
  const u8 = object('UNSIGNED8', 8);
  assert.match(bytes('256', u8), /! 256 does not fit UNSIGNED8/);
  assert.match(bytes('twelve', u8), /not a whole number/);
  assert.match(bytes('', u8), /Type a value/);
  assert.match(bytes('"save"', object('UNSIGNED16', 16)), /longer than 2 bytes/);
});

test('texts, bytes and reals', () => {
  assert.equal(bytes('GXMM', object('VISIBLE_STRING', 0)), '47584d4d');
  assert.equal(bytes('“GXMM”', object('VISIBLE_STRING', 0)), '47584d4d');
  assert.equal(bytes('01 02 ff', object('OCTET_STRING', 0)), '0102ff');
  assert.equal(bytes('1.5', object('REAL32', 32)), '0000c03f');
});

test('what was encoded is decoded', () => {
  for (const [text, of, value] of [
    ['-5', object('INTEGER24', 24), -5],
    ['4711', object('UNSIGNED16', 16), 4711],
    ['9007199254740993', object('UNSIGNED64', 64), 9007199254740993n],
    ['hello', object('VISIBLE_STRING', 0), 'hello'],
    ['0.25', object('REAL64', 64), 0.25],
  ] as const) {
    const encoded = encode(text, of);
    assert.ok('bytes' in encoded);
    assert.deepEqual(decode(encoded.bytes, of), value);
  }
});

test('limits and names', () => {
  assert.deepEqual(range(object('INTEGER8', 8)), { low: -128, high: 127 });
  assert.deepEqual(range(object('UNSIGNED8', 8, { low: 1, high: 127 })), { low: 1, high: 127 });
  assert.equal(range(object('DOMAIN', 0)), null);
  assert.equal(address(0x6004, 0), '6004h');
  assert.equal(address(0x1018, 10), '1018h:0A');
  assert.equal(showValue(1234567, object('UNSIGNED32', 32)), '1\u2009234\u2009567');
});
