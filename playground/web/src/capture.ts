// The console's views of the capture, and what a person chose in them.

import { effect, signal } from '@preact/signals-core';
import { parseFilter } from './trace/filter';
import { Trace } from './trace/trace';
import { knownWords, learnWords, wordsArrived } from './sim/words';
import * as state from './state';

export const trace = new Trace(state.ring);
trace.words = knownWords;

/** Changes when all rows were made again. */
export const refiltered = signal(0);
/** In order, one row for each identifier, or no frames but values over time. */
export const view = signal<'order' | 'ids' | 'plot'>('order');
export const filterText = signal('');
/** What is wrong with the filter, and where. */
export const filterError = signal<{ error: string; at: number } | null>(null);
/** What the second time column shows. */
export const gap = signal<'delta' | 'cycle'>('delta');
export const folds = signal(true);

/** Frames whose words a filter asks for at a time. */
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

/** A filter that looks at words learns those of all frames, portion by portion. */
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

/** The next marked frame after the chosen one, or before it; round the ends. */
export function nextBookmark(direction: 1 | -1): void {
  const marks = [...state.bookmarks.value].filter((number) => number >= state.ring.first).sort((a, b) => a - b);
  if (marks.length === 0) return;
  const from = state.chosenFrame.value ?? (direction > 0 ? -1 : Infinity);
  const next = direction > 0 ? marks.find((number) => number > from) : marks.findLast((number) => number < from);
  reveal(next ?? (direction > 0 ? marks[0]! : marks.at(-1)!));
}

/** Chooses a frame and asks the view to show it. */
export function reveal(number: number): void {
  state.chosenFrame.value = number;
  revealed.value = { number };
}

/** A frame that should be on screen. */
export const revealed = signal<{ number: number } | null>(null);

/** Chooses the next frame that passes a filter's text; answers what is wrong, or whether there is one. */
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
