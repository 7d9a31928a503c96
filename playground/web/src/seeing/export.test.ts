import { assert, test } from '../testing';
import { csv } from './export';
import { Series } from './series';

const of = (points: [number, number | null][]): Series => {
  const series = new Series();
  for (const [time, value] of points) series.push(time, value);
  return series;
};

test('a line for each moment, a column for each value', () => {
  const text = csv([
    { name: 'TPDO1 6004h Position value', series: of([[0.1, 5], [0.2, 6]]) },
    { name: 'Say "rpm", twice', series: of([[0.2, -1.5], [0.3, null]]) },
  ]);
  assert.equal(text, 'time in s,"TPDO1 6004h Position value","Say ""rpm"", twice"\n0.1,5,\n0.2,6,-1.5\n0.3,,\n');
});
