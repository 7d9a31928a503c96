// The capture: the last frames in one flat buffer. Every frame has a number that
// never changes, so a view can hold its place while old frames fall out.

import { FRAME_BYTES, unpack, type Frame } from '../sim/packed';

export const CAPACITY = 200_000;

export class Ring {
  private bytes = new Uint8Array(4096 * FRAME_BYTES);
  /** Number of the oldest frame that is kept. */
  first = 0;
  /** Number that the next frame will get. */
  end = 0;

  private get room(): number {
    return this.bytes.length / FRAME_BYTES;
  }

  append(batch: Uint8Array): void {
    let count = Math.floor(batch.length / FRAME_BYTES);
    if (count > CAPACITY) {
      this.end += count - CAPACITY;
      this.first = this.end;
      batch = batch.subarray((count - CAPACITY) * FRAME_BYTES);
      count = CAPACITY;
    }
    this.grow(this.end - this.first + count);
    let at = this.end % this.room;
    let from = 0;
    while (from < count) {
      const run = Math.min(count - from, this.room - at);
      this.bytes.set(batch.subarray(from * FRAME_BYTES, (from + run) * FRAME_BYTES), at * FRAME_BYTES);
      from += run;
      at = (at + run) % this.room;
    }
    this.end += count;
    this.first = Math.max(this.first, this.end - CAPACITY);
  }

  private grow(needed: number): void {
    if (needed <= this.room || this.room >= CAPACITY) return;
    const kept = this.slice(this.first, this.end);
    const room = Math.min(CAPACITY, Math.max(needed, this.room * 4));
    this.bytes = new Uint8Array(room * FRAME_BYTES);
    const end = this.end;
    this.end = this.first;
    this.append(kept);
    this.end = end;
  }

  clear(): void {
    this.first = this.end;
  }

  /** Forgets the newest frames, from this number on. */
  truncate(end: number): void {
    if (end < this.end) this.end = Math.max(end, this.first);
  }

  /** The frame with this number, if it is still there. */
  get(number: number): Frame | undefined {
    if (number < this.first || number >= this.end) return undefined;
    return unpack(this.bytes, (number % this.room) * FRAME_BYTES);
  }

  /** The packed bytes of one frame. */
  raw(number: number): Uint8Array {
    const at = (number % this.room) * FRAME_BYTES;
    return this.bytes.subarray(at, at + FRAME_BYTES);
  }

  private slice(from: number, to: number): Uint8Array {
    const out = new Uint8Array((to - from) * FRAME_BYTES);
    for (let number = from; number < to; number++) out.set(this.raw(number), (number - from) * FRAME_BYTES);
    return out;
  }
}
