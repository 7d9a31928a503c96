// The capture: the last frames in one flat buffer. Every frame has a number that
// never changes, so a view keeps its place while old frames are removed.

import { ERROR, tagAt, tags, type Tag } from '../codec';
import { TAG } from '../sim/layout';
import { AT, DISTURBED, FRAME_BYTES, unpack, type Packed } from '../sim/packed';

export const CAPACITY = 200_000;

/** A captured frame, with the facts from its CAN-ID and its bytes. */
export interface Frame extends Packed {
  tag: Tag;
  /** The node that sends or receives it; 0: none, or all. */
  node: number;
  /** The object that an SDO frame names, as `keyOf`. */
  object: number | null;
}

export class Ring {
  private bytes = new Uint8Array(4096 * FRAME_BYTES);
  /** The numbers of each frame, from `tags`. */
  private marks = new Uint32Array(4096 * TAG.length);
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
    const marks = tags(batch);
    let at = this.end % this.room;
    let from = 0;
    while (from < count) {
      const run = Math.min(count - from, this.room - at);
      this.bytes.set(batch.subarray(from * FRAME_BYTES, (from + run) * FRAME_BYTES), at * FRAME_BYTES);
      this.marks.set(marks.subarray(from * TAG.length, (from + run) * TAG.length), at * TAG.length);
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
    this.marks = new Uint32Array(room * TAG.length);
    const end = this.end;
    this.end = this.first;
    this.append(kept);
    this.end = end;
  }

  clear(): void {
    this.first = this.end;
  }

  /** Removes the newest frames, from this number on. */
  truncate(end: number): void {
    if (end < this.end) this.end = Math.max(end, this.first);
  }

  /** Removes the oldest frames, up to this number, excluding it. */
  forgetBefore(number: number): void {
    this.first = Math.max(this.first, Math.min(number, this.end));
  }

  /** Swaps the content with another ring. */
  exchange(other: Ring): void {
    const { bytes, marks, first, end } = this;
    Object.assign(this, { bytes: other.bytes, marks: other.marks, first: other.first, end: other.end });
    Object.assign(other, { bytes, marks, first, end });
  }

  /** The frame with this number, if it is still kept. */
  get(number: number): Frame | undefined {
    if (number < this.first || number >= this.end) return undefined;
    const at = number % this.room;
    const mark = this.marks[at * TAG.length]!;
    const frame = unpack(this.bytes, at * FRAME_BYTES) as Frame;
    frame.tag = frame.disturbed ? ERROR : tagAt(mark & TAG.mask);
    frame.node = (mark >> TAG.node) & TAG.mask;
    frame.object = mark >> TAG.object ? this.marks[at * TAG.length + 1]! : null;
    return frame;
  }

  /** Returns whether it is an SDO frame, without reading the frame. */
  isSdo(number: number): boolean {
    const at = number % this.room;
    return (this.bytes[at * FRAME_BYTES + AT.flags]! & DISTURBED) === 0 && tagAt(this.marks[at * TAG.length]! & TAG.mask).service === 'SDO';
  }

  /** The packed bytes of one frame. */
  raw(number: number): Uint8Array {
    const at = (number % this.room) * FRAME_BYTES;
    return this.bytes.subarray(at, at + FRAME_BYTES);
  }

  /** The packed bytes of the frames in a range of numbers. */
  slice(from: number, to: number): Uint8Array {
    const out = new Uint8Array((to - from) * FRAME_BYTES);
    for (let number = from; number < to; number++) out.set(this.raw(number), (number - from) * FRAME_BYTES);
    return out;
  }
}
