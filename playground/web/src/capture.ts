// The views of the capture in the console, and the choices of the user in them.

import { effect, signal } from '@preact/signals-core';
import { parseFilter } from './trace/filter';
import { Trace } from './trace/trace';
import { knownWords, learnWords, wordsArrived } from './sim/words';
import { FRAME_BYTES } from './sim/packed';
import * as state from './state';

export const trace = new Trace(state.ring);
trace.words = knownWords;

/** Changes when all rows were computed again. */
export const refiltered = signal(0);
/** In order, one row for each CAN-ID, a plot of values, or the faults in the frames. */
export const view = signal<'order' | 'ids' | 'nodes' | 'plot' | 'diagnosis'>('order');
export const filterText = signal('');
/** Message and place of an error in the filter. */
export const filterError = signal<{ error: string; at: number } | null>(null);
/** Content of the second time column. */
export const gap = signal<'delta' | 'cycle'>('delta');
export const folds = signal(true);

/** Number of frames for which a filter requests the text at once. */
const PORTION = 4000;
let isLearning = false;

export function setFilter(text: string): void {
  filterText.value = text;
  const parsed = parseFilter(text);
  if ('error' in parsed) {
    filterError.value = parsed;
    return;
  }
  filterError.value = null;
  trace.filter = parsed.filter;
  refilter();
  void learn();
}

export function setFolds(on: boolean): void {
  folds.value = on;
  trace.folds = on;
  refilter();
}

function refilter(): void {
  trace.refilter();
  refiltered.value = refiltered.peek() + 1;
}

/** A filter on texts gets those of all frames, in portions. */
async function learn(): Promise<void> {
  if (isLearning) return;
  isLearning = true;
  while (trace.filter?.needsWords && (await learnWords(PORTION))) refilter();
  isLearning = false;
}

effect(() => {
  void state.captured.value;
  if (trace.filter?.needsWords) void learn();
});

effect(() => {
  void state.cleared.value;
  trace.restart();
  refiltered.value = refiltered.peek() + 1;
  state.bookmarks.value = new Set();
});

export { wordsArrived };

export function toggleBookmark(number: number): void {
  const marks = new Set(state.bookmarks.value);
  if (!marks.delete(number)) marks.add(number);
  state.bookmarks.value = marks;
}

/** The next or previous marked frame relative to the selected one, wrapping around at the ends. */
export function nextBookmark(direction: 1 | -1): void {
  const marks = [...state.bookmarks.value].filter((number) => number >= state.ring.first).sort((a, b) => a - b);
  if (marks.length === 0) return;
  const from = state.chosenFrame.value ?? (direction > 0 ? -1 : Infinity);
  const next = direction > 0 ? marks.find((number) => number > from) : marks.findLast((number) => number < from);
  reveal(next ?? (direction > 0 ? marks[0]! : marks.at(-1)!));
}

/** Selects a frame and scrolls the view to it. */
export function reveal(number: number): void {
  state.chosenFrame.value = number;
  revealed.value = { number };
}

/** The frame to scroll to. */
export const revealed = signal<{ number: number } | null>(null);

/** The frames that pass the filter, packed. */
export function passing(): Uint8Array {
  const frames = Array.from({ length: trace.count }, (_, row) => trace.numberAt(row)).flatMap((number) => trace.fold(number)?.frames ?? [number]);
  const packed = new Uint8Array(frames.length * FRAME_BYTES);
  frames.forEach((number, place) => packed.set(state.ring.raw(number), place * FRAME_BYTES));
  return packed;
}

/** Selects the next frame that passes the filter; returns the error, or whether there is one. */
export async function find(text: string, direction: 1 | -1): Promise<string | boolean> {
  const parsed = parseFilter(text);
  if ('error' in parsed) return parsed.error;
  if (!parsed.filter) return false;
  if (parsed.filter.needsWords) while (await learnWords(PORTION));
  const count = trace.count;
  const chosen = state.chosenFrame.value;
  let row = chosen === null ? (direction > 0 ? -1 : count) : trace.rowOf(chosen);
  for (let looked = 0; looked < count; looked++) {
    row = (row + direction + count) % count;
    const number = trace.numberAt(row);
    const frame = state.ring.get(number);
    if (frame && parsed.filter.test(frame, knownWords(number))) {
      reveal(number);
      return true;
    }
  }
  return false;
}
