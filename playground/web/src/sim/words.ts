// The texts of the visible frames. The last frames of a batch include theirs;
// those of older frames are requested from the worker when they become visible.

import { effect, signal } from '@preact/signals-core';
import { cleared, devices, lesson, ring } from '../state';
import { askBus, listen } from './link';
import { german, said } from '../language';
import { T } from '../texts';
import { FRAME_BYTES, type Packed } from './packed';

/** Maximum number of texts: one for each frame of the capture, for a filter that checks all of them. */
const MOST_KEPT = 220_000;

const known = new Map<number, string>();
const asked = new Set<number>();

/** Changes when texts arrived later. */
export const wordsArrived = signal(0);

/** The signals of a DBC file in packed frames, in words; null without a file. */
let signalsIn: ((frames: Uint8Array) => Promise<string[]>) | null = null;

/** Adds signals to the text of each frame, or ends that. */
export function addSignals(of: typeof signalsIn): void {
  signalsIn = of;
  forget();
}

listen(({ words, frames }, first) => {
  if (signalsIn) return;
  if (known.size > MOST_KEPT) known.clear();
  const end = first + frames.length / FRAME_BYTES;
  // The others are not shown, or not captured.
  if (end !== ring.end) return;
  const from = end - words.length;
  words.forEach((text, i) => known.set(from + i, said(text)));
});

/** The texts of these frames, as far as they are known; requests the others. */
export function wordsOf(numbers: number[]): (string | undefined)[] {
  const missing = numbers.filter((number) => !known.has(number) && !asked.has(number) && number >= ring.first);
  if (missing.length > 0) void ask(missing);
  return numbers.map((number) => {
    const frame = ring.get(number);
    return frame?.disturbed ? troubleWords(frame) : known.get(number);
  });
}

/** The text of a frame, if it is known. */
export const knownWords = (number: number): string | undefined => {
  const frame = ring.get(number);
  return frame?.disturbed ? troubleWords(frame) : known.get(number);
};

/** Requests the texts of all kept frames, newest first; returns whether any was missing. */
export async function learnWords(most: number): Promise<boolean> {
  const missing: number[] = [];
  for (let number = ring.end - 1; number >= ring.first && missing.length < most; number--) {
    if (!known.has(number) && !asked.has(number) && !ring.get(number)?.disturbed) missing.push(number);
  }
  if (missing.length > 0) await ask(missing);
  return missing.length > 0;
}

// Another device gives bytes another meaning, and frame numbers repeat after a step back.
effect(() => {
  void devices.value;
  void cleared.value;
  void german.value;
  forget();
});

function forget(): void {
  known.clear();
  wordsArrived.value = wordsArrived.peek() + 1;
}

async function ask(numbers: number[]): Promise<void> {
  const frames = new Uint8Array(numbers.length * FRAME_BYTES);
  numbers.forEach((number, i) => {
    asked.add(number);
    frames.set(ring.raw(number), i * FRAME_BYTES);
  });
  const of = signalsIn;
  const [words, signals] = await Promise.all([askBus('describeAll', frames), of?.(frames)]);
  numbers.forEach((number, i) => {
    asked.delete(number);
    if (of !== signalsIn) return;
    const [text, more] = [said(words?.[i] ?? ''), signals?.[i]];
    known.set(number, more ? `${text} | ${more}` : text);
  });
  wordsArrived.value += 1;
}

/** Error that a controller sees in a failed attempt to send a frame. Its cause is named on the free bench only: in a lesson it is the question. */
export function troubleWords({ data }: Packed): string {
  const [why = 0, busOff = 0, low = 0, high = 0, ...attempts] = data;
  if (why === 0) return T.trouble.unknown;
  const count = attempts.reduce((sum, byte, place) => sum + byte * 256 ** place, 0);
  const cause = lesson.peek() ? '' : (T.trouble.cause[why] ?? '');
  return T.trouble.text(T.trouble.seen[why] ?? '', cause, count, low + 256 * high, busOff !== 0);
}
