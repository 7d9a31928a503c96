import { assert, test } from '../testing';
import { unpack, type Frame } from '../sim/packed';
import { read } from './read';
import { write, type Format } from './write';

const frame = (time: number, id: number, bytes: number[], more: Partial<Frame> = {}): Frame => ({
  time, id, extended: false, remote: false, fromPage: false, disturbed: false, device: 1, dlc: bytes.length, data: Uint8Array.from(bytes), ...more,
});

const FRAMES = [
  frame(0, 0x701, [0]),
  frame(100_000, 0x601, [0x40, 4, 0x60, 0, 0, 0, 0, 0], { fromPage: true }),
  frame(100_137, 0x581, [0x43, 4, 0x60, 0, 1, 2, 3, 4]),
  frame(200_000, 0x701, [], { remote: true, dlc: 1, fromPage: true }),
  frame(300_000, 0x80, []),
  frame(1_500_001, 0x1f334455, [0xde, 0xad], { extended: true }),
  frame(1_600_000, 0x181, [0, 0, 0, 0, 0, 0], { disturbed: true }),
];

const bytesOf = (file: string | Uint8Array): Uint8Array => (typeof file === 'string' ? new TextEncoder().encode(file) : file);
const all = (file: string | Uint8Array): Frame[] => {
  const log = read(bytesOf(file));
  assert.equal(log.skipped, 0, JSON.stringify(log.firstSkipped));
  return Array.from({ length: log.count }, (_, i) => unpack(log.frames, i * 24));
};

for (const format of ['log', 'asc', 'trc', 'pcapng'] as Format[]) {
  test(`${format} comes back as it was`, () => {
    const back = all(write(format, FRAMES));
    assert.equal(back.length, FRAMES.length);
    FRAMES.forEach((was, i) => {
      const is = back[i]!;
      // PEAK has microseconds, candump's compact form no direction.
      assert.ok(Math.abs(is.time - was.time) < 2, `${format} ${i}: ${is.time}`);
      assert.equal(is.disturbed, was.disturbed);
      if (was.disturbed) return;
      assert.deepEqual([is.id, is.extended, is.remote, is.dlc, [...is.data]], [was.id, was.extended, was.remote, was.dlc, [...was.data]]);
      if (format === 'asc' || format === 'trc') assert.equal(is.fromPage, was.fromPage);
    });
  });
}

test('what other tools write', () => {
  const one = (text: string): Frame => all(text)[0]!;
  assert.deepEqual(one('(1436509052.249713) vcan0 044#2A366C2BBA\n').data, Uint8Array.from([0x2a, 0x36, 0x6c, 0x2b, 0xba]));
  assert.equal(one(' (003.602976)  can0  181   [4]  01 02 03 04\n').id, 0x181);
  assert.ok(one(' (0.1)  can0  701   [1]  remote request\n').remote);
  assert.equal(one('date Sam Sep 30 15:06:13.191 2017\nbase hex  timestamps absolute\ninternal events logged\n// version 9.0.0\n   2.501000 1  8               Tx   d 8 00 00 00 00 00 00 00 00  Length = 0 BitCount = 64\n').dlc, 8);
  assert.equal(one('date x\nbase dec  timestamps absolute\n   1.0 1  100             Rx   d 2 10 255\n').data[1], 255);
  assert.ok(one('date x\nbase hex  timestamps absolute\n   0.1 1  64x             Rx   r\n').extended);
  assert.equal(one(';$FILEVERSION=1.1\n;$STARTTIME=43474.0\n     1)      1059.9  Rx         0300  7  00 00 00 00 04 00 00\n').data[4], 4);
  assert.ok(one(';$FILEVERSION=1.1\n     1)      1059.9  Rx         0300  4  RTR\n').remote);
  assert.equal(one(';$FILEVERSION=1.3\n     1)      1059.900 1  Rx        0300 -  2    00 07\n').data[1], 7);
  assert.equal(one(';##########\n     1)      1841 0001 8 00 00 00 00 00 00 00 09\n;$STARTTIME=1\n').data[7], 9);
  assert.equal(one(';$FILEVERSION=2.0\n;$STARTTIME=43008.0\n;$COLUMNS=N,O,T,I,d,l,D\n      1      1059.900 DT     0300 Rx 7  00 00 00 00 04 00 00\n').data[4], 4);
});

test('nothing is lost in silence', () => {
  const fails = (text: string | Uint8Array, why: RegExp): void => {
    try {
      read(bytesOf(text));
    } catch (error) {
      assert.match((error as Error).message, why);
      return;
    }
    throw new Error('it should not be read');
  };
  fails('hello\nworld\n', /neither/);
  fails('(0.1) can0 zzz#00\n', /line 1/);
  fails((write('pcapng', FRAMES) as Uint8Array).subarray(0, 90), /middle/);
  const log = read(bytesOf('(0.1) can0 601#40\n(0.2) can0 601#4\n(0.3) can0 801#00\n(0.4) can0 123##100\n'));
  assert.deepEqual([log.count, log.skipped, log.firstSkipped!.line], [1, 3, 2]);
});
