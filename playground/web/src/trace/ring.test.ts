import { pack } from '../sim/packed';
import { CAPACITY, Ring } from './ring';
import { assert, test } from '../testing';

const frames = (from: number, count: number): Uint8Array => {
  const all = new Uint8Array(count * 24);
  for (let i = 0; i < count; i++) {
    all.set(pack({ time: from + i, id: 0x181, extended: false, remote: false, fromPage: false, data: Uint8Array.of((from + i) & 255) }), i * 24);
  }
  return all;
};

test('every frame keeps its number', () => {
  const ring = new Ring();
  let next = 0;
  for (const count of [1, 5, 4096, 7, 20_000, 150_000, 60_000, 3]) {
    ring.append(frames(next, count));
    next += count;
    assert.equal(ring.end, next);
    assert.ok(ring.end - ring.first <= CAPACITY);
    for (const number of [ring.first, ring.first + 1, Math.floor((ring.first + ring.end) / 2), ring.end - 1]) {
      if (number < ring.end) assert.equal(ring.get(number)?.time, number);
    }
  }
  assert.equal(ring.get(ring.first - 1), undefined);
  assert.equal(ring.get(ring.end), undefined);
});

test('clearing continues the numbers', () => {
  const ring = new Ring();
  ring.append(frames(0, 10));
  ring.clear();
  assert.equal(ring.get(9), undefined);
  ring.append(frames(10, 5000));
  assert.equal(ring.get(10)?.time, 10);
  assert.equal(ring.get(5009)?.time, 5009);
});

test('of a batch larger than the ring the end stays', () => {
  const ring = new Ring();
  ring.append(frames(0, CAPACITY + 10));
  assert.equal(ring.first, 10);
  assert.equal(ring.get(CAPACITY + 9)?.time, CAPACITY + 9);
  assert.equal(ring.get(10)?.time, 10);
});

test('old frames are removed, and two captures can be swapped', () => {
  const [one, other] = [new Ring(), new Ring()];
  one.append(frames(0, 5000));
  one.forgetBefore(100);
  assert.deepEqual([one.first, one.get(99), one.get(100)?.time], [100, undefined, 100]);
  one.forgetBefore(50);
  assert.equal(one.first, 100);
  other.append(frames(70_000, 3));
  one.exchange(other);
  assert.deepEqual([one.end, one.get(2)?.time, other.first, other.get(4999)?.time], [3, 70_002, 100, 4999]);
  one.append(frames(1, 1));
  assert.deepEqual([one.get(3)?.time, other.end], [1, 5000]);
});
