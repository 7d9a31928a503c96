// Values of objects over virtual time, as far as they are kept.

import type { Value } from '../sim/api';

/** Points that are kept; the oldest quarter goes when there are more. */
export const MOST_POINTS = 12_000;

/** A value as a number, or null where it is none: a gap in the line. */
export function numeric(value: Value | undefined): number | null {
  if (typeof value === 'bigint') return Number(value);
  if (typeof value === 'boolean') return Number(value);
  return typeof value === 'number' ? value : null;
}

export class Series {
  /** Virtual seconds, rising. */
  times: number[] = [];
  /** One list for each object, as long as the times. */
  columns: (number | null)[][];

  constructor(count: number) {
    this.columns = Array.from({ length: count }, () => []);
  }

  /** Adds a moment. One that is not later than the last was reached by a step back: what came after it goes. */
  push(time: number, values: readonly (number | null)[]): void {
    let end = this.times.length;
    while (end > 0 && this.times[end - 1]! >= time) end -= 1;
    this.times.length = end;
    this.times.push(time);
    this.columns.forEach((column, i) => {
      column.length = end;
      column.push(values[i] ?? null);
    });
    if (this.times.length <= MOST_POINTS) return;
    this.times.splice(0, MOST_POINTS / 4);
    for (const column of this.columns) column.splice(0, MOST_POINTS / 4);
  }

  /** The last value of an object, the least and the most from a moment on. */
  range(i: number, from: number): { last: number | null; least: number; most: number } {
    const column = this.columns[i] ?? [];
    let least = Infinity;
    let most = -Infinity;
    for (let at = column.length - 1; at >= 0 && this.times[at]! >= from; at--) {
      const value = column[at];
      if (value === null || value === undefined) continue;
      least = Math.min(least, value);
      most = Math.max(most, value);
    }
    return { last: column.at(-1) ?? null, least, most };
  }
}
