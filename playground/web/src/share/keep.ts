// Keeps the last bench in this browser, so that closing a tab loses no work.

import { effect } from '@preact/signals-core';
import { loaded } from '../codec';
import { clear, createStore, del, entries, get, set } from 'idb-keyval';
import { language } from '../language';
import { isClass } from '../lessons/kept';
import * as state from '../state';
import { D } from '../views/texts';
import { resumed } from '../lessons/open';
import { read, write } from './bench';
import { now, open, openText } from './make';

/** Milliseconds between two saves. */
const PAUSE = 2000;
/** A longer run takes long to repeat, and is kept without its history. */
const MOST_ENTRIES = 5000;
const LONGEST_RUN = 3600e6;

interface Kept {
  /** Time in wall-clock milliseconds. */
  at: number;
  /** Names of the devices. */
  names: string[];
  /** Name of the lesson in progress; empty without one. */
  lesson?: string;
  text: string;
}

const store = createStore(isClass ? 'odkit-class' : 'odkit', 'kept');

/** Each visit stores its bench under a name of its own, so that two tabs do not overwrite each other. */
const own = crypto.randomUUID?.() ?? `${Date.now()} ${Math.random()}`;
/** Maximum number of stored benches; the oldest are removed. */
const MOST_KEPT = 8;
/** Milliseconds between two checks for a tab that closes. */
const LOOK = 250;

/** The stored benches that no open tab uses, newest first. */
async function left(patience = 0): Promise<{ key: IDBValidKey; kept: Kept }[]> {
  const all = await entries<IDBValidKey, Kept>(store);
  const held = await navigator.locks?.query().then(({ held: locks }) => locks, () => []);
  const open = new Set(held?.map(({ name }) => name));
  const isOther = all.some(([key]) => visitOf(key) !== own && open.has(lockOf(key)));
  // The previous page of the same tab releases its lock a moment after it is closed.
  if (isOther && patience > 0) {
    await new Promise((resolve) => setTimeout(resolve, LOOK));
    return left(patience - 1);
  }
  return all
    .filter(([key, kept]) => kept && visitOf(key) !== own && !open.has(lockOf(key)))
    .map(([key, kept]) => ({ key, kept }))
    .sort((a, b) => b.kept.at - a.kept.at);
}

/** A lesson has an entry of its own: the bench that was there before it is offered when the learner leaves it. */
const LESSON = ' lesson';
const keyNow = (): string => (state.lesson.peek() ? own + LESSON : own);

/** The bench that this tab stored before its page was reloaded. */
const KEY_OF_TAB = 'odkit.bench';

function ofTab(): string | null {
  try {
    const key = sessionStorage.getItem(KEY_OF_TAB);
    sessionStorage.setItem(KEY_OF_TAB, own);
    return key;
  } catch {
    // Storage is not allowed: nothing is kept.
    return null;
  }
}

/** Continues the lesson of this name where this tab was before a reload; false if it was in another one. */
export async function resume(name: string): Promise<boolean> {
  const key = ofTab();
  if (!key) return false;
  const all = await left(4).catch(() => []);
  const kept = all.find((one) => one.key === key + LESSON)?.kept;
  if (kept?.lesson !== name) return false;
  await loaded;
  const bench = read(kept.text);
  const lesson = bench.entries.findLast(({ input }) => input.op === 'lesson')?.input;
  if (lesson?.op !== 'lesson') return false;
  open(bench);
  resumed(name, lesson.text);
  resumedKey = key + LESSON;
  return true;
}

/** The bench that this visit continues; it is not offered again. */
let resumedKey: string | null = null;

/** The visit that stored an entry. */
const visitOf = (key: IDBValidKey): string => String(key).replace(LESSON, '');

const lockOf = (key: IDBValidKey): string => `odkit bench ${visitOf(key)}`;

/** Returns whether anything was done except putting devices on the bus. */
const isWorth = (): boolean => state.journal.entries.some(({ input }) => input.op !== 'add');

/** The stored benches are removed, and nothing is stored any more. */
let isOver = false;

/** Removes all stored benches; this visit stores no other. */
export function forget(): Promise<void> {
  isOver = true;
  return clear(store);
}

/** Starts to store the bench, and offers the previous one. */
export async function start(): Promise<void> {
  // The lock is held while this tab is open.
  void navigator.locks?.request(lockOf(own), () => new Promise(() => undefined));
  ofTab();
  let last: Kept | undefined;
  try {
    last = (await left(4)).find((one) => one.key !== resumedKey)?.kept;
  } catch {
    // Storage is not allowed: nothing is kept.
    return;
  }
  if (last) offer(last);
  let timer = 0;
  const keep = async (): Promise<void> => {
    timer = 0;
    if (isOver || !isWorth() || state.replaying.peek() || state.real.peek()) return;
    const isLong = state.journal.entries.length > MOST_ENTRIES || state.now.peek() > LONGEST_RUN;
    const bench = await now(!isLong);
    if (isOver || bench.entries.length === 0) return;
    try {
      await set(keyNow(), { at: Date.now(), names: state.devices.peek().map((one) => one.name), lesson: state.lesson.peek() ? state.lessonRun.peek().name : '', text: write(bench) }, store);
      await Promise.all((await left()).slice(MOST_KEPT).map(({ key }) => del(key, store)));
    } catch {
      // The disk is full, or the browser forbids it: the page works without.
    }
  };
  effect(() => {
    void state.journaled.value;
    if (isWorth()) timer ||= window.setTimeout(() => void keep(), PAUSE);
  });
  // A step that is done is stored at once: the next thing may be a reload.
  let step = -1;
  effect(() => {
    const reached = state.lessonState.value?.step ?? -1;
    if (reached > step && reached > 0) void keep();
    step = reached;
  });
  let isLesson = false;
  effect(() => {
    const was = isLesson;
    isLesson = state.lesson.value !== null;
    if (was && !isLesson) void get<Kept>(own, store).then((kept) => kept && offer(kept), () => undefined);
  });
  document.addEventListener('visibilitychange', () => {
    if (document.visibilityState === 'hidden') void keep();
  });
}

function offer(kept: Kept): void {
  state.offers.value = [
    ...state.offers.value,
    { key: 'kept', text: D.share.kept(kept.names.join(', '), when(kept.at)), action: D.share.goOn, run: () => void openText(kept.text, D.share.keptName) },
  ];
}

/** The bench that was stored before this visit. */
export const before = (): Promise<Kept | undefined> => left().then((all) => all[0]?.kept, () => undefined);

export const when = (at: number): string =>
  new Date(at).toLocaleString(language(), { dateStyle: 'medium', timeStyle: 'short' });
