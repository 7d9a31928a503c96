// Opens a lesson by its name, from an address, or from a file.

import { effect } from '@preact/signals-core';
import { openLesson, setRunning } from '../actions';
import { german, language } from '../language';
import * as state from '../state';
import { D } from '../views/texts';
import { finished, progress } from './kept';
import { keep, LONGEST, own, type Listed } from './own';

/** Title and summary in the language of the page, or in English. */
export const words = (one: Listed): { title: string; summary: string } => (german.value && one.de) || one;

/** The file of a lesson in the language of the page, or in English. */
const fileOf = (one: Listed): string => `lesson-${one.name}${german.value && one.de ? '.de' : ''}.md`;

/** Milliseconds that a server has to send a lesson. */
const PATIENCE = 10_000;

/** Milliseconds after which an empty bench is shown while a lesson loads. */
const SLOW = 1500;

let list: Promise<Listed[]> | null = null;

/** The lessons beside the page, which are fetched once, and those of the user. */
export async function lessons(): Promise<Listed[]> {
  list ??= load('lessons.json').then((text) => JSON.parse(text) as Listed[]);
  // The next attempt may succeed.
  list.catch(() => (list = null));
  return [...(await list), ...(await own())];
}

/** The text of a lesson of the list, in the language of the page. */
export const textOf = async (one: Listed): Promise<string> => one.text ?? load(fileOf(one));

/** A text beside the page. */
export async function load(address: string): Promise<string> {
  const answer = await fetch(new URL(address, new URL('./', location.href)), { signal: AbortSignal.timeout(PATIENCE) });
  if (!answer.ok) throw new Error(`${answer.status} ${answer.statusText}`.trim());
  const body = await answer.blob();
  if (body.size > LONGEST) throw new Error(D.lessons.tooLarge);
  return body.text();
}

/** A question without its recipe, with the answer of a step of a lesson. */
export interface Asked {
  lesson: string;
  /** Step of the answer, counted from 1. */
  step: number;
  /** Title of the lesson. */
  title: string;
  question: string;
  answer: string;
  reveal: string;
}

const asked = new Map<string, Promise<Asked[]>>();

/** The questions in the language of the page; they are fetched once. */
export function questions(): Promise<Asked[]> {
  const file = `questions.${language()}.json`;
  const known = asked.get(file) ?? load(file).then((text) => JSON.parse(text) as Asked[]);
  asked.set(file, known);
  // The next attempt may succeed.
  known.catch(() => asked.delete(file));
  return known;
}

/** The questions of a lesson without their recipe, by step, counted from 0. */
export const shortOf = async (name: string): Promise<Map<number, string>> =>
  new Map((await questions()).filter((one) => one.lesson === name).map((one) => [one.step - 1, one.question]));

/** A question of a completed lesson, asked at the start of the lesson with this name; null if there is none. */
export async function recalled(name: string): Promise<Asked | null> {
  const done = finished();
  const known = (await questions()).filter((one) => one.lesson !== name && done.has(one.lesson));
  // Different lessons ask different questions; a lesson asks the same one at each start.
  const place = (await lessons()).findIndex((one) => one.name === name);
  return known[(place * 7) % known.length] ?? null;
}

function unreachable(name: string, error: unknown): false {
  const isSlow = error instanceof Error && error.name === 'TimeoutError';
  const why = isSlow ? D.lessons.tooSlow : error instanceof Error ? error.message : String(error);
  state.toast.value = { text: D.lessons.unreachable(name, why), tone: 'error' };
  return false;
}

/**
 * Opens a lesson of the list, or the text at an address; false if that fails. While a slow server
 * loads, `meanwhile` makes a bench, which the lesson replaces.
 */
export async function openNamed(name: string, meanwhile?: () => Promise<void>): Promise<boolean> {
  let made: Promise<void> | undefined;
  const timer = setTimeout(() => (made = meanwhile?.()), SLOW);
  try {
    const ours = (await lessons().catch(() => [])).find((one) => one.name === name);
    const text = await (ours ? textOf(ours) : load(name));
    clearTimeout(timer);
    await made;
    const [done = 0, all = 0] = progress()[name] ?? [];
    if (!(await tried(name, text))) return false;
    if (done > 0 && done < all && all === state.lesson.value?.steps.length && !state.real.value) await goOn(done, all);
    if (ours) history.replaceState(null, '', `${location.pathname}#lesson=${encodeURIComponent(name)}`);
    return true;
  } catch (error) {
    clearTimeout(timer);
    await made;
    return unreachable(name, error);
  }
}

/** Continues a lesson that the learner left after this number of steps, and says so. */
async function goOn(done: number, all: number): Promise<void> {
  await backTo(done);
  state.toast.value = { text: D.lessons.goesOn(done + 1, all), tone: 'info', action: { text: D.lessons.fromStart, run: () => void again() } };
}

/** Opens a file of the user, and adds it to the list; false if that fails. */
export async function openFile(file: File): Promise<boolean> {
  if (file.size > LONGEST) return unreachable(file.name, D.lessons.tooLarge);
  const text = await file.text();
  if (!(await tried(file.name, text))) return false;
  await keep(file.name, text);
  history.replaceState(null, '', `${location.pathname}#lesson=${encodeURIComponent(file.name)}`);
  return true;
}

let last = '';

/** The lesson that follows this one in the list, which is in groups by level: the next that is not done, or null. */
export async function following(name: string): Promise<Listed | null> {
  const group = ({ isOwn, level }: Listed): number => (isOwn ? 0 : level);
  const all = (await lessons().catch(() => [])).sort((a, b) => group(a) - group(b));
  const done = finished();
  const at = all.findIndex((one) => one.name === name);
  return [...all.slice(at + 1), ...all.slice(0, Math.max(at, 0))].find((one) => !done.has(one.name)) ?? null;
}

/** Continues a lesson on a bench that is restored with it; its last step is shown when the run is there. */
export function resumed(name: string, text: string): void {
  last = text;
  state.tab.value = 'lesson';
  const stop = effect(() => {
    const { value: progress } = state.lessonState;
    if (!progress || state.replaying.value) return;
    queueMicrotask(() => {
      stop();
      state.lessonRun.value = { name, count: state.lessonRun.peek().count + 1, step: progress.step };
      // The step that was done had paused the time; the next one is open.
      setRunning(true);
    });
  });
}

/** Restarts the lesson in progress. */
export const again = (): Promise<boolean> => tried(state.lessonRun.value.name, last);

/** Starts one of its steps again; the steps before it are done with their solutions. */
export async function backTo(step: number): Promise<void> {
  const steps = state.lesson.value?.steps ?? [];
  await openLesson(state.lessonRun.value.name, last, steps.slice(0, step).map(({ solution }) => solution));
}

/** Starts a step of a lesson of the list again in the language of the page. */
export async function translated(one: Listed, step: number): Promise<void> {
  try {
    last = await textOf(one);
  } catch (error) {
    unreachable(one.name, error);
    return;
  }
  await backTo(step);
}

/** Opens a lesson; its errors are shown in the list of lessons. */
async function tried(name: string, text: string): Promise<boolean> {
  const isOpen = await openLesson(name, text);
  if (isOpen) last = text;
  state.lessonDialog.value = !isOpen;
  return isOpen;
}
