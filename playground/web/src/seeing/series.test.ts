import { assert, test } from '../testing';
import { numeric, Series } from './series';

test('values become numbers, or gaps', () => {
  assert.deepEqual([5, 5n, true, null, 'text', new Uint8Array(2), undefined].map(numeric), [5, 5, 1, null, null, null, null]);
});

test('a step back removes later values', () => {
  const series = new Series();
  for (const time of [1, 2, 3]) series.push(time, time * 10);
  series.push(1.5, 7);
  assert.deepEqual([series.times, series.values], [[1, 1.5], [10, 7]]);
  // Two values at one moment, as two frames can give.
  series.push(1.5, 8);
  assert.deepEqual(series.times, [1, 1.5, 1.5]);
});

test('a value holds until the next one', () => {
  const series = new Series();
  for (const [time, value] of [[1, 10], [2, null], [3, 30]] as const) series.push(time, value);
  assert.deepEqual([0.5, 1, 1.9, 2.5, 9].map((time) => series.at(time)), [null, 10, 10, null, 30]);
  assert.deepEqual(series.range(0, 2.5), { least: 10, most: 10 });
  assert.deepEqual(series.range(0, 3), { least: 10, most: 30 });
  assert.ok(series.range(1.5, 2.5).least > series.range(1.5, 2.5).most, 'nothing there');
});

test('memory is limited, and peaks stay', () => {
  const series = new Series(1000);
  for (let i = 0; i < 100_000; i++) series.push(i, i === 777 ? 5000 : i === 1234 ? -5000 : i % 10);
  assert.ok(series.times.length <= 1000);
  assert.equal(series.times[0], 0, 'from the first moment');
  assert.ok(series.times.every((time, i) => i === 0 || time >= series.times[i - 1]!), 'in order');
  assert.deepEqual(series.range(0, 2000), { least: -5000, most: 5000 });
  assert.deepEqual(series.times.slice(-100), Array.from({ length: 100 }, (_, i) => 99_900 + i), 'the latest are all there');
});
