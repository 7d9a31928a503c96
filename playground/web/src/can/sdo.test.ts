import { Transfer, type Outcome, type Request } from './sdo';
import { assert, test } from '../testing';

/** Runs a transfer against prepared answers; what was sent, and how it ended. */
function run(request: Request, answers: number[][]): { sent: string[]; outcome: Outcome | null } {
  const sent: string[] = [];
  let outcome: Outcome | null = null;
  const transfer = new Transfer(
    1,
    request,
    (id, data) => sent.push(`${id.toString(16)} ${Array.from(data, (byte) => byte.toString(16).padStart(2, '0')).join('')}`),
    (end) => (outcome = end),
  );
  transfer.start();
  for (const answer of answers) transfer.receive(0x581, Uint8Array.from({ length: 8 }, (_, i) => answer[i] ?? 0));
  return { sent, outcome };
}

const text = (words: string): number[] => Array.from(words, (letter) => letter.charCodeAt(0));

test('expedited upload, size indicated or not', () => {
  const request = { index: 0x6200, sub: 0, bytes: null };
  const { sent, outcome } = run(request, [[0x4b, 0, 0x62, 0, 5, 0]]);
  assert.deepEqual(sent, ['601 4000620000000000']);
  assert.deepEqual(outcome, { kind: 'read', bytes: Uint8Array.of(5, 0) });
  assert.deepEqual(run(request, [[0x42, 0, 0x62, 0, 5, 0]]).outcome, { kind: 'read', bytes: Uint8Array.of(5, 0, 0, 0) });
});

test('segmented upload', () => {
  const { sent, outcome } = run({ index: 0x2001, sub: 0, bytes: null }, [
    [0x41, 1, 0x20, 0, 9],
    [0x00, ...text('segment')],
    [0x1b, ...text('ed')],
  ]);
  assert.deepEqual(sent, ['601 4001200000000000', '601 6000000000000000', '601 7000000000000000']);
  assert.deepEqual(outcome, { kind: 'read', bytes: Uint8Array.from(text('segmented')) });
});

test('expedited and segmented download', () => {
  const small = run({ index: 0x1017, sub: 0, bytes: Uint8Array.of(0xf4, 1) }, [[0x60, 0x17, 0x10, 0]]);
  assert.deepEqual(small.sent, ['601 2b171000f4010000']);
  assert.deepEqual(small.outcome, { kind: 'written' });
  const large = run({ index: 0x2001, sub: 0, bytes: Uint8Array.from(text('segmented')) }, [[0x60, 1, 0x20, 0], [0x20], [0x30]]);
  assert.deepEqual(large.sent, ['601 2101200009000000', '601 007365676d656e74', '601 1b65640000000000']);
  assert.deepEqual(large.outcome, { kind: 'written' });
});

test('an abort ends it, another object does not', () => {
  const request = { index: 0x1000, sub: 0, bytes: Uint8Array.of(1) };
  assert.deepEqual(run(request, [[0x60, 0x01, 0x10, 0]]).outcome, null);
  assert.deepEqual(run(request, [[0x80, 0, 0x10, 0, 2, 0, 1, 6]]).outcome, { kind: 'aborted', code: 0x06010002 });
});

test('silence ends it', () => {
  let outcome: Outcome | null = null;
  const transfer = new Transfer(1, { index: 0x1000, sub: 0, bytes: null }, () => {}, (end) => (outcome = end));
  transfer.start();
  transfer.tick(1000);
  assert.equal(outcome, null);
  transfer.tick(2_000_000);
  assert.deepEqual(outcome, { kind: 'silent' });
});
