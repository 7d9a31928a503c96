// A log that is open beside the capture. The console shows one of the two; the shelf keeps the other.

import { batch, signal } from '@preact/signals-core';
import * as state from '../state';
import type { Ring } from '../trace/ring';

/** The log beside the capture, and which of the two is shown. `ring` has the frames of the hidden one. */
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

/** Opens a log beside the capture, and shows it; it replaces an earlier log. */
export function putBeside(name: string, ring: Ring): void {
  showLive();
  beside.value = { name, ring, isShown: false };
  show(true);
}

/** Closes the log. */
export function close(): void {
  showLive();
  beside.value = null;
}
