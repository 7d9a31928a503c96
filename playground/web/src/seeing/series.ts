// One value over virtual time. The number of points is limited: older points are thinned out, and
// their minimum and maximum stay.

import type { Value } from '../sim/api';

const MOST_POINTS = 16_000;

/** A value as a number, or null if it is not one: a gap in the line. */
export function numeric(value: Value | undefined): number | null {
  if (typeof value === 'bigint') return Number(value);
  if (typeof value === 'boolean') return Number(value);
  return typeof value === 'number' ? value : null;
}

export class Series {
  /** Virtual seconds, in ascending order. */
  times: number[] = [];
  values: (number | null)[] = [];

  constructor(private readonly most = MOST_POINTS) {}

  clear(): void {
    this.times = [];
    this.values = [];
  }

  /** Adds a value. A time before the last one follows a step back: later values are removed. */
  push(time: number, value: number | null): void {
    let end = this.times.length;
    while (end > 0 && this.times[end - 1]! > time) end -= 1;
    this.times.length = end;
    this.values.length = end;
    this.times.push(time);
    this.values.push(value);
    if (this.times.length > this.most) this.coarsen();
  }

  /** Of each four points in the older half the minimum and the maximum stay. */
  private coarsen(): void {
    const half = this.most >> 1;
    const times: number[] = [];
    const values: (number | null)[] = [];
    for (let from = 0; from < half; from += 4) {
      const group = this.values.slice(from, Math.min(half, from + 4));
      const known = group.filter((value) => value !== null);
      const [low, high] = [group.indexOf(Math.min(...known)), group.lastIndexOf(Math.max(...known))];
      // A gap stays, and so does the first moment.
      const kept = new Set([from === 0 ? 0 : low, low, high, group.indexOf(null)]);
      for (const place of [...kept].filter((place) => place >= 0).sort((a, b) => a - b)) {
        times.push(this.times[from + place]!);
        values.push(group[place]!);
      }
    }
    this.times = times.concat(this.times.slice(half));
    this.values = values.concat(this.values.slice(half));
  }

  /** The last index whose time is not after this one; -1 if there is none. */
  placeAt(time: number): number {
    let [low, high] = [0, this.times.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.times[middle]! <= time) low = middle + 1;
      else high = middle;
    }
    return low - 1;
  }

  /** The value at a moment: the last one before it. */
  at(time: number): number | null {
    return this.values[this.placeAt(time)] ?? null;
  }

  /** Minimum and maximum between two moments; the minimum is above the maximum if there is no value. */
  range(from: number, to: number): { least: number; most: number } {
    let [least, most] = [Infinity, -Infinity];
    for (let place = this.placeAt(to); place >= 0 && this.times[place]! >= from; place--) {
      const value = this.values[place];
      if (value === null || value === undefined) continue;
      least = Math.min(least, value);
      most = Math.max(most, value);
    }
    return { least, most };
  }
}
