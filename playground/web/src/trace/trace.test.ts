import { assert, test } from '../testing';
import { pack } from '../sim/packed';
import { parseFilter, type Filter } from './filter';
import { Ring } from './ring';
import { Trace } from './trace';

const send = (ring: Ring, time: number, id: number, bytes: number[]): void =>
  ring.append(pack({ time, id, extended: false, remote: false, fromPage: false, data: Uint8Array.from(bytes) }));

const filter = (text: string): Filter | null => {
  const parsed = parseFilter(text);
  return 'filter' in parsed ? parsed.filter : null;
};

test('rows, CAN-IDs and periods', () => {
  const ring = new Ring();
  const trace = new Trace(ring);
  for (let i = 0; i < 10; i++) {
    send(ring, i * 1000, 0x181, [i]);
    if (i % 2) send(ring, i * 1000 + 10, 0x701, [5]);
  }
  assert.equal(trace.follow(), 0);
  assert.equal(trace.count, 15);
  assert.equal(trace.before(trace.identifiers.get(0x181)!.last)!.data[0], 8);
  assert.deepEqual([...trace.statistics.ids().subarray(0, 8)], [0x181, 10, 1000, 1000, 1000, 1000, 0, 9000]);
  trace.filter = filter('hb');
  trace.refilter();
  assert.equal(trace.count, 5);
  send(ring, 10_000, 0x181, [1]);
  send(ring, 10_000, 0x701, [5]);
  trace.follow();
  assert.equal(trace.count, 6);
  assert.equal(trace.lately(10_000).frames, 17);
  assert.equal(trace.statistics.ids()[1], 11, 'what the filter hides counts');
  trace.filter = null;
  trace.refilter();
  assert.equal(trace.count, 17);
  assert.equal(trace.numberAt(trace.rowOf(4)), 4);
});

test('frames that leave the store leave the rows', () => {
  const ring = new Ring();
  const trace = new Trace(ring);
  const batch = new Uint8Array(24 * 150_000);
  ring.append(batch);
  trace.follow();
  ring.append(batch);
  assert.equal(trace.follow(), 100_000);
  assert.equal(trace.count, 200_000);
  assert.equal(trace.numberAt(0), 100_000);
});

test('a capture that was cut is read again', () => {
  const ring = new Ring();
  const trace = new Trace(ring);
  for (let i = 0; i < 6; i++) send(ring, i, 0x181, [i]);
  trace.follow();
  ring.truncate(3);
  trace.follow();
  assert.equal(trace.count, 3);
  assert.equal(trace.statistics.ids()[1], 3);
});
