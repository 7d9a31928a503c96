import { assert, test } from '../testing';
import { Folder, type Fold } from './fold';
import type { Frame } from '../sim/packed';

const frame = (line: string): Frame => {
  const [id, hex] = line.split('#') as [string, string];
  const data = Uint8Array.from(hex.replaceAll(' ', '').match(/../g) ?? [], (pair) => Number.parseInt(pair, 16));
  return { time: 0, id: Number.parseInt(id, 16), extended: false, remote: false, fromPage: false, disturbed: false, device: 1, dlc: data.length, data };
};

function run(lines: string[]): { rows: number; fold: Fold | null } {
  const folder = new Folder();
  let fold: Fold | null = null;
  let rows = 0;
  lines.forEach((line, number) => {
    const into = folder.take(frame(line), number);
    if (into) fold = into;
    else rows += 1;
  });
  return { rows, fold };
}

test('expedited transfers keep their rows', () => {
  assert.deepEqual(run(['601#4004600000000000', '581#4304600001020304', '601#2B17100064000000', '581#6017100000000000']), { rows: 4, fold: null });
});

test('a segmented upload is one row', () => {
  const { rows, fold } = run(['601#4008100000000000', '581#4108100009000000', '701#7F', '601#6000000000000000', '581#0031323334353637', '601#7000000000000000', '581#1B38390000000000', '601#4000100000000000']);
  assert.equal(rows, 3);
  assert.equal(fold!.state, 'done');
  assert.deepEqual(fold!.frames, [0, 1, 3, 4, 5, 6]);
  assert.equal(String.fromCharCode(...fold!.bytes), '123456789');
  assert.equal(fold!.length, 9);
});

test('a segmented download, and one that is aborted', () => {
  const done = run(['601#2101200009000000', '581#6001200000000000', '601#0031323334353637', '581#2000000000000000', '601#1B38390000000000', '581#3000000000000000']);
  assert.equal(done.rows, 1);
  assert.equal(done.fold!.state, 'done');
  assert.equal(String.fromCharCode(...done.fold!.bytes), '123456789');
  const aborted = run(['601#2101200009000000', '581#6001200000000000', '601#0031323334353637', '581#8001200000000504', '601#4000100000000000', '581#4300100000000000']);
  assert.equal(aborted.rows, 3);
  assert.equal(aborted.fold!.state, 'aborted');
});

test('a block upload', () => {
  const { rows, fold } = run(['601#A408100008000000', '581#C208100009000000', '601#A300000000000000', '581#0131323334353637', '581#8238390000000000', '601#A202080000000000', '581#D500000000000000', '601#A100000000000000']);
  assert.equal(rows, 1);
  assert.equal(fold!.state, 'done');
  assert.equal(String.fromCharCode(...fold!.bytes), '123456789');
});

test('a block download', () => {
  const { rows, fold } = run(['601#C201200009000000', '581#A401200008000000', '601#0131323334353637', '601#8238390000000000', '581#A202080000000000', '601#D500000000000000', '581#A100000000000000', '601#4000100000000000']);
  assert.equal(rows, 2);
  assert.equal(fold!.state, 'done');
  assert.equal(String.fromCharCode(...fold!.bytes), '123456789');
});
