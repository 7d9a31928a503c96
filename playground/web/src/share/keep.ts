// The last bench, kept in this browser: nobody loses his work by closing a tab.

import { effect } from '@preact/signals-core';
import { createStore, get, set } from 'idb-keyval';
import * as state from '../state';
import { T } from '../texts';
import { write } from './bench';
import { now, openText } from './make';

/** Milliseconds between two savings. */
const PAUSE = 2000;
/** Beyond these, a run takes long to make again, and is kept without its past. */
const MOST_ENTRIES = 5000;
const LONGEST_RUN = 3600e6;

interface Kept {
  /** When, in wall-clock milliseconds. */
  at: number;
  /** Names of the devices. */
  names: string[];
  text: string;
}

const store = createStore('odkit', 'kept');

const load = (key: 'last' | 'before'): Promise<Kept | undefined> => get(key, store);
const save = (key: 'last' | 'before', kept: Kept): Promise<void> => set(key, kept, store);

/** Has anything been done but putting devices on the bus? */
const isWorth = (): boolean => state.journal.entries.some(({ input }) => input.op !== 'add');

/** Begins to keep the bench, and offers the one that was kept before. */
export async function start(): Promise<void> {
  let last: Kept | undefined;
  try {
    last = await load('last');
  } catch {
    // Storage is off: nothing is kept.
    return;
  }
  if (last) offer(last);
  let isFirst = true;
  let timer = 0;
  const keep = async (): Promise<void> => {
    timer = 0;
    if (!isWorth() || state.replaying.peek()) return;
    const isLong = state.journal.entries.length > MOST_ENTRIES || state.now.peek() > LONGEST_RUN;
    const bench = await now(!isLong);
    if (bench.entries.length === 0) return;
    try {
      // What a session finds is not lost when it saves for the first time.
      if (isFirst && last) await save('before', last);
      isFirst = false;
      await save('last', { at: Date.now(), names: state.devices.peek().map((one) => one.name), text: write(bench) });
    } catch {
      // The disk is full, or the browser forbids it: the page works without.
    }
  };
  effect(() => {
    void state.journaled.value;
    if (isWorth()) timer ||= window.setTimeout(() => void keep(), PAUSE);
  });
  document.addEventListener('visibilitychange', () => {
    if (document.visibilityState === 'hidden') void keep();
  });
}

function offer(kept: Kept): void {
  state.offers.value = [
    ...state.offers.value,
    { key: 'kept', text: T.share.kept(kept.names.join(', '), when(kept.at)), action: T.share.goOn, run: () => void openText(kept.text, T.share.keptName) },
  ];
}

/** The bench before the one that was kept last. */
export const before = (): Promise<Kept | undefined> => load('before').catch(() => undefined);

export const when = (at: number): string =>
  new Date(at).toLocaleString('en', { dateStyle: 'medium', timeStyle: 'short' });
