import { assert, test } from '../testing';
import { NoBench, read, write, type Bench } from './bench';
import { pack, unpack } from './pack';

const bench: Bench = {
  trace: true,
  now: 2_500_000,
  speed: 10,
  running: false,
  node: 1,
  entries: [
    { at: 0, input: { op: 'add', source: { kind: 'builtin', name: 'gxmm' }, nodeId: 5 } },
    { at: 0, input: { op: 'add', source: { kind: 'eds', name: 'ü.eds', text: '[1000]\nß', lenient: true }, nodeId: 6, place: 1 } },
    { at: 10, input: { op: 'switches', node: 0, dip: { bit: 4, on: true } } },
    { at: 10, input: { op: 'line', real: true, terminators: 1, rate: null } },
    { at: 11.5, input: { op: 'send', id: 0x605, data: Uint8Array.of(0x40, 4, 0x60, 0, 0, 0, 0, 255), extended: false, remote: false } },
    { at: 12, input: { op: 'follow', node: 0, steps: [60, 2000, 0, 100], repeats: true } },
    { at: 13, input: { op: 'turn', node: 0, turns: -1.25 } },
  ],
};

function fault(text: string): string {
  try {
    read(text);
  } catch (error) {
    if (error instanceof NoBench) return error.message;
    throw error;
  }
  return '';
}

test('a bench is read as it was written', async () => {
  const packed = await pack(write(bench));
  assert.match(packed, /^[A-Za-z0-9_-]+$/);
  assert.deepEqual(read(await unpack(packed)), bench);
});

test('every truncated text is refused', () => {
  const text = write(bench);
  for (let length = 0; length < text.length; length++) assert.ok(fault(text.slice(0, length)), `${length}`);
});

test('every field is checked', () => {
  const whole = JSON.parse(write(bench)) as Record<string, unknown>;
  const withInput = (change: object): string => JSON.stringify({ ...whole, entries: [[0, { op: 'turn', node: 0, turns: 1, ...change }]] });
  assert.equal(fault(withInput({})), '');
  assert.equal(fault(withInput({ turns: 'x' })), 'cut');
  assert.equal(fault(withInput({ turns: 1e300 })), 'cut');
  assert.equal(fault(withInput({ node: -1 })), 'cut');
  assert.equal(fault(withInput({ node: 0.5 })), 'cut');
  assert.equal(fault(withInput({ op: 'explode' })), 'newer');
  assert.equal(fault(withInput({ op: 'constructor' })), 'newer');
  assert.equal(fault(JSON.stringify({ ...whole, odkit: 2 })), 'newer');
  assert.equal(fault('{"a":1}'), 'other');
  assert.equal(fault('[]'), 'other');
  assert.equal(fault('null'), 'other');
  assert.equal(fault(JSON.stringify({ ...whole, now: -1 })), 'cut');
  assert.equal(fault(JSON.stringify({ ...whole, entries: [[5, { op: 'seed', seed: 1 }], [4, { op: 'seed', seed: 1 }]] })), 'cut');
});

test('a run beyond its limits is refused before it starts', () => {
  const add = { op: 'add', source: { kind: 'builtin', name: 'gxmm' }, nodeId: 5 };
  const run = (entries: unknown[], now: number): string => fault(JSON.stringify({ ...(JSON.parse(write(bench)) as object), entries, now }));
  assert.equal(run([[0, add]], 86_400e6), '');
  assert.equal(run([[0, add]], 86_401e6), 'time');
  assert.equal(run(Array.from({ length: 2000 }, () => [0, add]), 0), 'devices');
  assert.equal(run([[0, { op: 'repeat', key: 1, id: 128, data: '', extended: false, remote: false, micros: 100 }]], 86_400e6), 'frames');
});

test('damaged addresses are refused without an exception', async () => {
  const packed = await pack(write(bench));
  for (const wrong of ['', '%', 'AAAA', packed.slice(0, 20), packed.slice(0, -4), `x${packed}`]) {
    let message = '';
    await unpack(wrong).then(read).catch((error: unknown) => (message = error instanceof NoBench ? error.message : `thrown: ${String(error)}`));
    assert.match(message, /^(cut|other|newer)$/, wrong);
  }
});
