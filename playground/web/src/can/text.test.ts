import { candumpLine, parseFrame, typedForm } from './text';
import { assert, test } from '../testing';

const typed = (text: string): string => {
  const parsed = parseFrame(text);
  if ('error' in parsed) return `${parsed.at}: ${parsed.error}`;
  const { id, extended, remote, data, dlc } = parsed.frame;
  return typedForm({ time: 0, fromPage: true, disturbed: false, device: 0, id, extended, remote, data, dlc });
};

test('frames in every spelling', () => {
  for (const text of [
    '601#4004600000000000',
    '601#40 04 60 00 00 00 00 00',
    '  601 40 04 60 00 00 00 00 00 ',
    '601#40.04.60.00.00.00.00.00',
    '0x601 40,04,60,00,00,00,00,00',
    '601h 40 4 60 0 0 0 0 0',
    '601   [8]  40 04 60 00 00 00 00 00',
    '601: 40 04 60 00 00 00 00 00',
  ]) {
    assert.equal(typed(text), '601#40 04 60 00 00 00 00 00', text);
  }
  assert.equal(typed('0#0101'), '000#01 01');
  assert.equal(typed('80'), '080#');
  assert.equal(typed('601#40 04 60 00 00'), '601#40 04 60 00 00');
  assert.equal(typed('12345678#01'), '12345678#01');
});

test('remote frames', () => {
  assert.equal(typed('701#R'), '701#R');
  assert.equal(typed('701 r'), '701#R');
  assert.equal(typed('181#R4'), '181#R4');
  assert.equal(typed('181 [4] rtr'), '181#R4');
});

test('faults, and where they are', () => {
  const fault = (text: string, at: number, words: RegExp): void => {
    const parsed = parseFrame(text);
    assert.ok('error' in parsed, text);
    assert.match(parsed.error, words);
    assert.equal(parsed.at, at, text);
  };
  fault('', 0, /COB-ID/);
  fault('xyz#00', 0, /hexadecimal/);
  fault('800#00', 0, /7FF/);
  fault('1234#00', 0, /3 digits, or 8/);
  fault('FFFFFFFF#00', 0, /1FFFFFFF/);
  fault('601#4g', 5, /“g”/);
  fault('601#00 11 22 33 44 55 66 77 88', 27, /8 bytes/);
  fault('601 [2] 40', 7, /promises 2/);
  fault('601#R9', 5, /8 bytes/);
});

test('candump lines', () => {
  const frame = { id: 0x601, extended: false, remote: false, fromPage: true, disturbed: false, device: 0, dlc: 4, data: new Uint8Array([0x40, 4, 0x60, 0]) };
  assert.equal(candumpLine({ ...frame, time: 1_000_001 }), '(1.000001) can0 601#40046000');
  assert.equal(candumpLine({ ...frame, time: 0, remote: true, data: new Uint8Array(0) }), '(0.000000) can0 601#R4');
  assert.equal(candumpLine({ ...frame, time: 0, id: 0x12, extended: true }), '(0.000000) can0 00000012#40046000');
});
