// Changing what a PDO carries (CiA 301, chapter 7.5.2.36): switch the mapping off, write
// its entries, switch it on; each step is an SDO download of one frame.

export interface Mapped {
  index: number;
  sub: number;
  bits: number;
}

/** What a step does; the two `pdo` steps only where they are wanted. */
export type StepKind = 'pdo off' | 'off' | 'entry' | 'on' | 'pdo on';

export interface Step {
  kind: StepKind;
  index: number;
  sub: number;
  bytes: Uint8Array;
}

/** A PDO carries 8 bytes. */
export const MOST_BITS = 64;
/** Bit 31 of a COB-ID: the PDO does not exist. */
const INVALID = 0x8000_0000;

export const isMapping = (index: number): boolean => isTransmit(index) || (index >= 0x1600 && index <= 0x17ff);
export const isTransmit = (index: number): boolean => index >= 0x1a00 && index <= 0x1bff;
/** The object with the COB-ID of a PDO. */
export const communication = (mapping: number): number => mapping - 0x200;

export const unpackMapped = (value: number): Mapped => ({ index: value >>> 16, sub: (value >>> 8) & 255, bits: value & 255 });

/** The steps that lead to these entries; with a COB-ID, the PDO is off meanwhile. */
export function stepsTo(mapping: number, entries: readonly Mapped[], cobId: number | null): Step[] {
  const write = (kind: StepKind, index: number, sub: number, bytes: Uint8Array): Step => ({ kind, index, sub, bytes });
  const steps = [
    write('off', mapping, 0, Uint8Array.of(0)),
    ...entries.map(({ index, sub, bits }, i) => write('entry', mapping, i + 1, wide(index * 0x1_0000 + sub * 256 + bits))),
    write('on', mapping, 0, Uint8Array.of(entries.length)),
  ];
  if (cobId === null) return steps;
  const of = communication(mapping);
  return [write('pdo off', of, 1, wide((cobId | INVALID) >>> 0)), ...steps, write('pdo on', of, 1, wide(cobId))];
}

function wide(value: number): Uint8Array {
  const bytes = new Uint8Array(4);
  new DataView(bytes.buffer).setUint32(0, value, true);
  return bytes;
}

/** The expedited download that a step is. */
export function frameOf({ index, sub, bytes }: Step): Uint8Array {
  const frame = new Uint8Array(8);
  frame.set([0x23 | ((4 - bytes.length) << 2), index & 255, index >> 8, sub]);
  frame.set(bytes, 4);
  return frame;
}
