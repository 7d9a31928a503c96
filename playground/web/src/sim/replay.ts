// Replays a log: its frames with their original distances, at any speed,
// with pauses, and one by one.

import type { Input } from './api';
import { FRAME_BYTES, unpack, type Packed } from './packed';

export class Replay {
  private place = 0;
  /** This moment of the log corresponds to the current moment of the bench. */
  private log: number;
  private isPaused = false;

  /** `frames` are packed, in the order of their times; `bench` is the moment of the first. */
  constructor(
    private readonly frames: Uint8Array,
    private bench: number,
    private speed: number,
  ) {
    this.log = this.next?.time ?? 0;
  }

  get left(): number {
    return this.frames.length / FRAME_BYTES - this.place;
  }

  private get next(): Packed | null {
    return this.left > 0 ? unpack(this.frames, this.place * FRAME_BYTES) : null;
  }

  /** Time when the next frame is due. */
  get due(): number {
    const { next } = this;
    if (!next) return -Infinity;
    return this.isPaused ? Infinity : Math.round(this.bench + Math.max(0, next.time - this.log) / this.speed);
  }

  /** Sets the speed, pauses or continues: the remaining distance to the next frame stays. */
  set(now: number, { speed = this.speed, paused = this.isPaused }: { speed?: number | undefined; paused?: boolean | undefined }): void {
    if (!this.isPaused) this.log = Math.min(this.next?.time ?? Infinity, this.log + Math.max(0, now - this.bench) * this.speed);
    this.bench = now;
    this.speed = speed;
    this.isPaused = paused;
  }

  /** The next frame as an input; null if it was disturbed on the recorded bus line, or the log has ended. */
  take(now: number): Extract<Input, { op: 'send' }> | null {
    const frame = this.next;
    if (!frame) return null;
    this.place += 1;
    if (this.isPaused) [this.log, this.bench] = [frame.time, now];
    if (frame.disturbed) return null;
    const data = frame.remote ? new Uint8Array(frame.dlc) : frame.data.slice();
    return { op: 'send', id: frame.id, data, extended: frame.extended, remote: frame.remote };
  }
}
