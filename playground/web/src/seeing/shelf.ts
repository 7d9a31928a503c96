// A log that was opened beside the capture: one of the two is shown, and the other is on the shelf.

import { batch, signal } from '@preact/signals-core';
import * as state from '../state';
import type { Ring } from '../trace/ring';

/** The log beside the capture, and which of them is shown. Its ring holds what is not shown. */
export const beside = signal<{ name: string; ring: Ring; isShown: boolean } | null>(null);

/** Shows the log, or the capture. */
export function show(isShown: boolean): void {
  const log = beside.peek();
  if (!log || log.isShown === isShown) return;
  state.ring.exchange(log.ring);
  state.live.ring = isShown ? log.ring : state.ring;
  batch(() => {
    beside.value = { ...log, isShown };
    state.chosenFrame.value = null;
    state.pausedAt.value = null;
    state.captured.value = state.ring.end;
    state.cleared.value += 1;
  });
}

export const showLive = (): void => show(false);

/** Puts a log beside the capture, and shows it; one that was there goes. */
export function putBeside(name: string, ring: Ring): void {
  showLive();
  beside.value = { name, ring, isShown: false };
  show(true);
}

/** Takes the log away. */
export function close(): void {
  showLive();
  beside.value = null;
}
