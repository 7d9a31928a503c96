// The views of the capture: its rows in order (filtered, folded), its CAN-IDs with
// their figures, and the bus load. All of them follow one store.

import { Statistics, Transfers } from '../codec';
import { AT, EXTENDED, FRAME_BYTES, DISTURBED, REMOTE } from '../sim/packed';
import type { Transfer } from '../sim/api';
import type { Filter } from './filter';
import { CAPACITY, type Frame, type Ring } from './ring';

/** A CAN-ID, and the number of its latest frame. */
export interface Identifier {
  id: number;
  extended: boolean;
  last: number;
}

/** Bits on the bus line, with the average number of stuff bits. */
const bitsOf = (flags: number, dlc: number): number => {
  const body = (flags & EXTENDED ? 67 : 47) + (flags & REMOTE ? 0 : 8 * dlc);
  return body * 1.1;
};

/** Virtual microseconds over which load and frames per second are measured. */
const WINDOW = 1_000_000;

export class Trace {
  /** Numbers of the first frames of all rows; those before `head` left the store. */
  private rows: number[] = [];
  private head = 0;
  /** The next frame to read. */
  private next = 0;
  private made: Transfers | undefined;
  private figures: Statistics | undefined;
  /** Numbers of the first frames of transfers with several frames. */
  private readonly folded = new Set<number>();
  /** For each kept frame the previous one with its CAN-ID; by number modulo capacity. */
  private readonly previous = new Int32Array(CAPACITY).fill(-1);
  /** By CAN-ID, plus 2³² if it has 29 bits. */
  readonly identifiers = new Map<number, Identifier>();
  private recent: { time: number; bits: number; frames: number }[] = [];
  errors = 0;
  filter: Filter | null = null;
  folds = true;
  /** Texts of frames, as far as they are known; terms of the filter may need them. */
  words: (number: number) => string | undefined = () => undefined;

  constructor(private readonly ring: Ring) {}

  /** Number of rows. */
  get count(): number {
    return this.rows.length - this.head;
  }

  /** The frame that a row begins with. */
  numberAt(row: number): number {
    return this.rows[this.head + row] ?? -1;
  }

  /** Created with the first frame; the module is loaded then. */
  private get transfers(): Transfers {
    return (this.made ??= new Transfers());
  }

  /** Figures of each CAN-ID and each SDO client. */
  get statistics(): Statistics {
    return (this.figures ??= new Statistics());
  }

  /** The transfer that is folded into the row of this frame. */
  fold(number: number): Transfer | null {
    return this.folded.has(number) ? this.transfers.transfer(number) : null;
  }

  /** Number of rows that begin before this frame. */
  rowsBefore(number: number): number {
    let [low, high] = [this.head, this.rows.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.rows[middle]! < number) low = middle + 1;
      else high = middle;
    }
    return low - this.head;
  }

  /** The row that shows a frame, or would show it. */
  rowOf(number: number): number {
    return Math.max(0, this.rowsBefore(number + 1) - 1);
  }

  /** The previous frame with the same CAN-ID. */
  before(number: number): Frame | undefined {
    const previous = this.previous[number % CAPACITY] ?? -1;
    return previous < 0 ? undefined : this.ring.get(previous);
  }

  /** Reads the frames since the last call; returns how many rows were removed at the top. */
  follow(): number {
    const { ring } = this;
    if (this.next > ring.end) this.restart();
    if (this.next < ring.first) this.next = ring.first;
    const from = this.next;
    for (; this.next < ring.end; this.next++) this.take(this.next);
    if (this.next > from) this.statistics.take(ring.slice(from, this.next));
    let lost = 0;
    while (this.head < this.rows.length && this.rows[this.head]! < ring.first) {
      this.folded.delete(this.rows[this.head]!);
      this.head += 1;
      lost += 1;
    }
    if (lost > 0) this.made?.forgetBefore(ring.first);
    if (this.head > 50_000) {
      this.rows = this.rows.slice(this.head);
      this.head = 0;
    }
    return lost;
  }

  private take(number: number): void {
    const bytes = this.ring.raw(number);
    const view = new DataView(bytes.buffer, bytes.byteOffset, FRAME_BYTES);
    const flags = bytes[AT.flags]!;
    const id = view.getUint32(AT.id, true);
    const time = view.getFloat64(AT.time, true);
    this.previous[number % CAPACITY] = -1;
    if (flags & DISTURBED) this.errors += 1;
    else this.note(id, (flags & EXTENDED) !== 0, number);
    this.load(time, bitsOf(flags, bytes[AT.dlc]!));
    this.place(number);
  }

  /** Gives a frame a row, unless it belongs to the row of another frame or the filter hides it. */
  private place(number: number): void {
    const { ring, filter } = this;
    const first = this.folds && ring.isSdo(number) ? this.transfers.take(ring.raw(number), number) : undefined;
    if (first !== undefined) this.folded.add(first);
    else if (!filter || filter.test(ring.get(number)!, filter.needsWords ? this.words(number) : undefined)) this.rows.push(number);
  }

  private note(id: number, extended: boolean, number: number): void {
    const key = extended ? id + 0x1_0000_0000 : id;
    const known = this.identifiers.get(key);
    if (known) this.previous[number % CAPACITY] = known.last;
    this.identifiers.set(key, { id, extended, last: number });
  }

  private load(time: number, bits: number): void {
    const slot = Math.floor(time / (WINDOW / 10));
    const latest = this.recent.at(-1);
    if (latest?.time === slot) {
      latest.bits += bits;
      latest.frames += 1;
      return;
    }
    this.recent.push({ time: slot, bits, frames: 1 });
    if (this.recent.length > 12) this.recent.shift();
  }

  /** Frames and bits in the second before `now`. */
  lately(now: number): { frames: number; bits: number } {
    const from = Math.floor((now - WINDOW) / (WINDOW / 10));
    let [frames, bits] = [0, 0];
    for (const slot of this.recent) {
      if (slot.time <= from) continue;
      frames += slot.frames;
      bits += slot.bits;
    }
    return { frames, bits };
  }

  /** Sets another filter or other folds: all rows are computed again, statistics stay. */
  refilter(): void {
    this.rows = [];
    this.head = 0;
    this.folded.clear();
    this.made?.clear();
    const { ring } = this;
    for (let number = ring.first; number < this.next && number < ring.end; number++) this.place(number);
  }

  /** The capture was cleared or cut: everything is computed again. */
  restart(): void {
    this.rows = [];
    this.head = 0;
    this.folded.clear();
    this.made?.clear();
    this.identifiers.clear();
    this.figures?.clear();
    this.recent = [];
    this.errors = 0;
    this.next = this.ring.first;
  }
}
