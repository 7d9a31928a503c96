import { assert, test } from '../testing';
import { frameOf, stepsTo, unpackMapped } from './mapping';
import { hexBytes } from '../format';

const position = { index: 0x6004, sub: 0, bits: 32 };
const speed = { index: 0x6030, sub: 1, bits: 16 };

test('three steps change a mapping', () => {
  const frames = stepsTo(0x1a00, [position, speed], null).map((step) => `${step.kind}: ${hexBytes(frameOf(step))}`);
  assert.deepEqual(frames, [
    'off: 2F 00 1A 00 00 00 00 00',
    'entry: 23 00 1A 01 20 00 04 60',
    'entry: 23 00 1A 02 10 01 30 60',
    'on: 2F 00 1A 00 02 00 00 00',
  ]);
});

test('the PDO can be off meanwhile, and is as it was afterwards', () => {
  const steps = stepsTo(0x1a01, [], 0x4000_0285);
  assert.deepEqual(steps.map(({ kind }) => kind), ['pdo off', 'off', 'on', 'pdo on']);
  assert.equal(hexBytes(frameOf(steps[0]!)), '23 01 18 01 85 02 00 C0');
  assert.equal(hexBytes(frameOf(steps[3]!)), '23 01 18 01 85 02 00 40');
});

test('an entry names its object', () => {
  assert.deepEqual(unpackMapped(0x6030_0110), speed);
  assert.deepEqual(unpackMapped(0xffff_ffff), { index: 0xffff, sub: 255, bits: 255 });
});
