// The page's side of the worker. It starts it, restarts it after a crash, and
// turns its reports into state.

import { batch } from '@preact/signals-core';
import { said } from '../language';
import * as state from '../state';
import { T } from '../texts';
import { begin } from '../codec';
import type { RealReport } from '../real/api';
import type { Applied, Address, Command, DeviceInfo, Entry, Input, Lesson, Questions, Report, Snapshot, Tools } from './api';
import { showLive } from '../seeing/shelf';
import { Ring } from '../trace/ring';
import { trusted } from '../trusted';
import { FRAME_BYTES } from './packed';

/** Number of crashes in a row after which the page stops trying. */
const MOST_CRASHES = 3;
/** Milliseconds between two checks whether the worker responds. */
const LOOK = 250;
/** Checks without an answer after which the worker counts as hung: two seconds. */
const MOST_UNANSWERED = 8;

/** Virtual microseconds over which the load is measured, and between two measurements. */
const LOAD_WINDOW = 1_000_000;
const LOAD_STEP = 50_000;

let worker: Worker | null = null;
/** Checks since its last report; a page that was itself blocked sends none. */
let unanswered = 0;
let watchdog = 0;
let lookedAt = 0;
let crashes = 0;
let ticket = 0;
/** Callers that wait for an answer, and the answer that they get if the worker ends first. */
const waiting = new Map<number, { resolve(value: unknown): void; otherwise: unknown }>();
/** Listeners for new frames. */
const listeners = new Set<(snapshot: Snapshot, first: number) => void>();

/** Handler of a real bus, once it is loaded. */
export const hooks = {
  real(_: RealReport): void {},
  crashed(): void {},
  /** Called when something was to be sent while sending is off. */
  held(): void {},
};

/** Returns whether sending is allowed: on a real bus only after the user switched it on. */
export const maySend = (): boolean => state.real.peek()?.sending !== false;

export function start(): void {
  unanswered = 0;
  watchdog ||= window.setInterval(look, LOOK);
  const own = new Worker(trusted('worker.js'), { type: 'module', name: 'odkit simulation' });
  worker = own;
  // Late messages of a worker that was ended are ignored.
  own.onmessage = ({ data }: MessageEvent<Report>) => {
    if (own === worker) receive(data);
  };
  own.onerror = (event) => {
    event.preventDefault();
    if (own === worker) crashed(event.message || T.app.unloaded);
  };
}

export function send(command: Command): void {
  worker?.postMessage(command);
}

/** Sends an input to the bench. */
export function act(input: Input): void {
  if (!maySend() && (input.op === 'send' || (input.op === 'repeat' && input.micros > 0))) return hooks.held();
  send({ op: 'do', input });
}

/** Sends a request to the worker; `otherwise` is the answer if it ends first. */
export function ask<T>(make: (ticket: number) => Command, otherwise: T): Promise<T> {
  return new Promise((resolve) => {
    ticket += 1;
    waiting.set(ticket, { resolve: resolve as (value: unknown) => void, otherwise });
    send(make(ticket));
  });
}

/** Adds a device, starts a lesson, plays a script; if that fails, the bench stays as it is. */
export const add = (input: Extract<Input, { op: 'add' | 'lesson' | 'script' }>): Promise<Applied & { entry?: number }> =>
  ask((ticket) => ({ op: 'do', input, ticket }), { node: null, diagnostics: [] });

/** Goes back to the moment before a journal entry, and removes the later entries. */
export const takeBack = (entry: number): Promise<null> => ask((ticket) => ({ op: 'back', to: null, entry, ticket }), null);

/** Adds the description of a real node to the devices. */
export const describe = (input: Input): Promise<Applied & { entry?: number }> => ask((ticket) => ({ op: 'real', what: { is: 'describe', ticket, input } }), { node: null, diagnostics: [] });

/** Repeats a run from the start; a quiet one does not show the frames of its first moment. */
export function restore(entries: Entry[], until: number, quiet = false, waits = false): void {
  state.journal.entries = [];
  dropFrames();
  send({ op: 'restore', entries, until, quiet, waits });
}

/** The inputs that make this bench without its history; null if there are none. */
export const setup = (): Promise<Entry[] | null> => ask((ticket) => ({ op: 'setup', ticket }), null);

/** A DCF of a device with its current configuration. */
export const exportDcf = (node: number): Promise<string | null> => ask((ticket) => ({ op: 'dcf', ticket, node }), null);

/** Asks the bus the same question about several things. */
export const askEach = <K extends keyof Questions>(name: K, calls: Parameters<Questions[K]>[]): Promise<ReturnType<Questions[K]>[]> =>
  ask((ticket) => ({ op: 'ask', ticket, name, calls }), []);

/** Asks the bus; null if it ends before it answers. */
export const askBus = async <K extends keyof Questions>(name: K, ...args: Parameters<Questions[K]>): Promise<ReturnType<Questions[K]> | null> =>
  (await askEach(name, [args]))[0] ?? null;

/** Calls the whole module; returns the result, or the reason why it failed. */
export const use = <K extends keyof Tools>(name: K, ...args: Parameters<Tools[K]>): Promise<{ value: ReturnType<Tools[K]> } | { error: string }> =>
  ask((ticket) => ({ op: 'tool', ticket, name, args }), { error: T.app.ended });

/** Calls `listener` with every snapshot and the number of its first frame. */
export function listen(listener: (snapshot: Snapshot, first: number) => void): () => void {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

/** Ends a worker that hangs. A worker that is still loading cannot answer yet. */
function look(): void {
  if (state.health.peek() !== 'running') return;
  const at = performance.now();
  const isLate = at - lookedAt > LOOK * 1.6;
  lookedAt = at;
  // If the page itself is blocked, the worker may be, too.
  if (isLate) return;
  if (unanswered >= MOST_UNANSWERED) return crashed(null);
  unanswered += 1;
  send({ op: 'ping' });
}

function receive(report: Report): void {
  unanswered = 0;
  switch (report.op) {
    case 'ready':
      begin(report.module);
      state.health.value = 'running';
      state.builtins.value = report.builtins;
      break;
    case 'answer':
      resolve(report.ticket, report.value);
      break;
    case 'devices':
      devices(report.devices, report.lesson);
      break;
    case 'rewound':
      rewound(report.to);
      break;
    case 'real':
      hooks.real(report.what);
      break;
    case 'snapshot':
      apply(report.snapshot);
      requestAnimationFrame(() => send({ op: 'drawn' }));
      break;
    case 'crashed':
      crashed(report.message);
      break;
  }
}

/** Null: no answer will follow. */
function resolve(ticket: number, value: unknown): void {
  const asked = waiting.get(ticket);
  asked?.resolve(value ?? asked.otherwise);
  waiting.delete(ticket);
}

function devices(list: DeviceInfo[], lesson: Lesson | null): void {
  // The same bench at another moment: what is shown stays.
  const known = state.devices.peek();
  const isBack = list.length > 0 && list.length === known.length && list.every(({ name, nodeId }, i) => name === known[i]!.name && nodeId === known[i]!.nodeId);
  batch(() => {
    state.devices.value = list;
    state.lesson.value = lesson;
    if (!lesson) state.lessonState.value = null;
    if (state.selectedNode.value >= list.length) select(Math.max(0, list.length - 1));
    if (!isBack) {
      state.selected.value = null;
      state.values.value = new Map();
      state.lastPdo.value = null;
    }
  });
  document.title = list.length ? T.app.devices(list.map((one) => one.name).join(', ')) : T.app.empty;
}

/** Shows another device in the panels. */
export function select(node: number): void {
  batch(() => {
    state.selectedNode.value = node;
    state.selected.value = null;
    state.values.value = new Map();
    state.unsaved.value = new Set();
    state.eeprom.value = null;
    state.chain.value = null;
    state.lastPdo.value = null;
  });
  send({ op: 'select', node });
}

function rewound(to: number): void {
  const { ring } = state.live;
  state.replaced.value = null;
  let end = ring.end;
  while (end > ring.first && (ring.get(end - 1)?.time ?? 0) > to) end -= 1;
  ring.truncate(end);
  batch(() => {
    state.lastPdo.value = null;
    for (let number = end - 1; number >= ring.first && state.lastPdo.value === null; number--) notePdo(number, ring);

    state.pausedAt.value = null;
    state.chosenFrame.value = null;
    state.captured.value = ring.end;
    state.cleared.value += 1;
  });
}

/** Later snapshots are of another bench. */
export function dropFrames(): void {
  showLive();
  state.ring.clear();
  batch(() => {
    state.capturing.value = true;
    state.trigger.value = null;
    state.chosenFrame.value = null;
    state.pausedAt.value = null;
    state.captured.value = state.ring.end;
    state.cleared.value += 1;
  });
}

function apply(snapshot: Snapshot): void {
  const first = state.live.ring.end;
  batch(() => {
    state.now.value = snapshot.now;
    state.rate.value = snapshot.rate;
    state.running.value = snapshot.running;
    state.replaying.value = snapshot.replaying;
    state.real.value = snapshot.real;
    state.toSend.value = snapshot.toSend;
    state.statuses.value = snapshot.nodes;
    note(snapshot.now, snapshot.line.busy);
    state.line.value = snapshot.line;
    state.lessonState.value = snapshot.lesson;
    state.chain.value = snapshot.chain;
    if (snapshot.values) watchedValues(snapshot);
    if (snapshot.unsaved) state.unsaved.value = new Set(snapshot.unsaved);
    if (snapshot.eeprom) state.eeprom.value = snapshot.eeprom;
    if (snapshot.journal) {
      const { from, entries } = snapshot.journal;
      state.journal.entries.length = Math.min(state.journal.entries.length, from);
      state.journal.entries.push(...entries);
      state.journaled.value += 1;
    }
    if (snapshot.frames.length > 0) frames(snapshot);
    const text = snapshot.notices.at(-1);
    if (text) state.toast.value = { text: said(text), tone: 'error' };
  });
  for (const listener of listeners) listener(snapshot, first);
}

/** Handles frames while the capture is stopped: the last PDO is still known. */
const passing = new Ring();

function frames(snapshot: Snapshot): void {
  const ring = state.capturing.peek() ? state.live.ring : passing;
  ring.append(snapshot.frames);
  for (let number = ring.end - snapshot.frames.length / FRAME_BYTES; number < ring.end; number++) notePdo(number, ring);
  if (ring === state.ring) state.captured.value = ring.end;
}

/** Keeps a frame that is PDO1 of the selected device. */
function notePdo(number: number, ring: Ring): void {
  const frame = ring.get(number);
  const isOurs = frame?.tag.text === 'PDO1' && frame.node === state.nodeId.value && !frame.fromPage;
  if (isOurs) state.lastPdo.value = { time: frame.time, data: frame.data };
}

/** Busy time of the bus line, at moments of the last second. */
let busy: { at: number; micros: number }[] = [];

/** Computes the load of a line with bit times: a frame in transmission counts completely. */
function note(at: number, micros: number): void {
  if (busy.length > 0 && (at < busy.at(-1)!.at || micros < busy.at(-1)!.micros)) busy = [];
  if (at - (busy.at(-1)?.at ?? -Infinity) >= LOAD_STEP) busy.push({ at, micros });
  while (busy.length > 1 && busy[1]!.at <= at - LOAD_WINDOW) busy.shift();
  const first = busy[0];
  state.load.value = first && at > first.at ? Math.min(100, ((micros - first.micros) / (at - first.at)) * 100) : 0;
}

let watched: Address[] = [];
let chosen: Address | null = null;

/** The objects whose values are shown. */
export function watch(addresses: Address[], one: Address | null): void {
  watched = addresses;
  chosen = one;
  send({ op: 'watch', addresses, chosen });
}

function watchedValues(snapshot: Snapshot): void {
  const fresh = snapshot.values;
  if (!fresh || fresh.length !== watched.length) return;
  const map = new Map(state.values.peek());
  watched.forEach(({ index, sub }, i) => map.set(state.keyOf(index, sub), fresh[i] ?? null));
  state.values.value = map;
  state.savedValue.value = snapshot.saved;
}

/**
 * A Rust panic, or a worker that hangs (`why` is null), ends the worker, not the page. A new
 * one repeats the run up to the last moment that the page received, which excludes the cause. If
 * it fails once more, only the devices are restored.
 */
function crashed(why: string | null): void {
  worker?.terminate();
  worker = null;
  crashes += 1;
  if (state.real.peek()) hooks.crashed();
  for (const { resolve, otherwise } of waiting.values()) resolve(otherwise);
  waiting.clear();
  if (crashes > MOST_CRASHES) {
    state.health.value = 'failed';
    state.toast.value = { text: T.app.crashed(why ?? T.app.hung), tone: 'error' };
    return;
  }
  state.health.value = 'restarting';
  state.toast.value = { text: why === null ? T.app.hungRestarted : T.app.restarted(why), tone: 'error' };
  start();
  watch(watched, chosen);
  send({ op: 'speed', factor: state.speed.peek() });
  send({ op: 'select', node: state.selectedNode.peek() });
  const at = state.now.peek();
  if (crashes === 1) {
    restore([...state.journal.entries], at, false, true);
  } else {
    state.journal.entries = [];
    // Continues at the moment when it stopped, so that time on the page does not run backwards.
    const entries = state.devices.peek().map(({ source, nodeId }): Entry => ({ at, input: { op: 'add', source, nodeId } }));
    send({ op: 'restore', entries, until: at, quiet: false });
  }
  send({ op: 'run', running: state.running.peek() });
  setTimeout(() => (crashes = 0), 10_000);
}
