import { MOST_POINTS, Series, numeric } from './series';
import { assert, test } from '../testing';

test('values that are no numbers are gaps', () => {
  assert.deepEqual([5, 5n, true, null, 'x', Uint8Array.of(1), undefined].map(numeric), [5, 5, 1, null, null, null, null]);
});

test('a step back takes what came after it', () => {
  const series = new Series(2);
  for (const time of [1, 2, 3, 4]) series.push(time, [time * 10, null]);
  series.push(2, [7, 8]);
  assert.deepEqual(series.times, [1, 2]);
  assert.deepEqual(series.columns, [[10, 7], [null, 8]]);
});

test('the oldest points go first, and all columns stay as long as the times', () => {
  const series = new Series(1);
  for (let time = 0; time < 3 * MOST_POINTS; time++) series.push(time, [time]);
  assert.ok(series.times.length <= MOST_POINTS && series.times.length > MOST_POINTS / 2);
  assert.deepEqual(series.times, series.columns[0]);
  assert.equal(series.times.at(-1), 3 * MOST_POINTS - 1);
});

test('the range is that of what is shown, without the gaps', () => {
  const series = new Series(1);
  [9, 4, null, 6].forEach((value, time) => series.push(time, [value]));
  assert.deepEqual(series.range(0, 1), { last: 6, least: 4, most: 6 });
  assert.deepEqual(series.range(0, 0), { last: 6, least: 4, most: 9 });
  assert.equal(new Series(1).range(0, 0).last, null);
});
