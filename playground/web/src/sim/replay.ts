// A log that is sent again: its frames, each as long after the first as they were.

import type { Input } from './api';
import { FRAME_BYTES, unpack } from './packed';

export class Replay {
  private place = 0;
  private readonly first: number;

  /** `frames` are packed, in the order of their times; `from` is the moment of the first. */
  constructor(
    private readonly frames: Uint8Array,
    private readonly from: number,
    private readonly speed: number,
  ) {
    this.first = frames.length ? unpack(frames, 0).time : 0;
  }

  get left(): number {
    return this.frames.length / FRAME_BYTES - this.place;
  }

  /** When the next frame is due. */
  get due(): number {
    if (this.left <= 0) return -Infinity;
    return Math.round(this.from + Math.max(0, unpack(this.frames, this.place * FRAME_BYTES).time - this.first) / this.speed);
  }

  next(): Extract<Input, { op: 'send' }> | null {
    if (this.left <= 0) return null;
    const frame = unpack(this.frames, this.place * FRAME_BYTES);
    this.place += 1;
    const data = frame.remote ? new Uint8Array(frame.dlc) : frame.data.slice();
    return { op: 'send', id: frame.id, data, extended: frame.extended, remote: frame.remote };
  }
}
