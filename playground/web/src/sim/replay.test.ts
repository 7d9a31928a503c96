import { assert, test } from '../testing';
import { pack } from './packed';
import { Replay } from './replay';

const log = (...times: number[]): Uint8Array => {
  const all = new Uint8Array(times.length * 24);
  times.forEach((time, i) => all.set(pack({ time, id: 0x100 + i, extended: false, remote: false, fromPage: true, data: Uint8Array.of(i) }), i * 24));
  return all;
};

test('frames keep their distances, at any speed', () => {
  const replay = new Replay(log(5000, 6000, 9000), 100, 2);
  const dues: number[] = [];
  while (replay.left > 0) {
    dues.push(replay.due);
    replay.take(replay.due);
  }
  assert.deepEqual(dues, [100, 600, 2100]);
  assert.equal(replay.due, -Infinity);
});

test('a pause or another speed keeps the remaining distance', () => {
  const replay = new Replay(log(0, 1000), 0, 1);
  replay.take(0);
  replay.set(400, { paused: true });
  assert.equal(replay.due, Infinity);
  replay.set(5000, { paused: false });
  assert.equal(replay.due, 5600);
  replay.set(5100, { speed: 0.5 });
  assert.equal(replay.due, 6100);
});

test('frames are sent one by one, and then continue', () => {
  const replay = new Replay(log(0, 1000, 3000), 0, 1);
  replay.set(0, { paused: true });
  assert.deepEqual([replay.take(50)?.id, replay.take(60)?.id, replay.left], [0x100, 0x101, 1]);
  replay.set(100, { paused: false });
  assert.equal(replay.due, 2100);
});

test('a frame that was disturbed is not sent', () => {
  const frames = log(0, 10);
  frames[12] = 8;
  const replay = new Replay(frames, 0, 1);
  assert.deepEqual([replay.take(0), replay.left, replay.take(10)?.id], [null, 1, 0x101]);
});
