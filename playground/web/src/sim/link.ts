// The page's end of the worker. It starts it, starts it again after a crash, and
// turns its reports into state.

import { batch } from '@preact/signals-core';
import * as state from '../state';
import { T } from '../texts';
import { begin } from '../codec';
import type { Added, Address, Command, DeviceInfo, Entry, Input, Lesson, Questions, Report, Snapshot, Tools } from './api';
import { FRAME_BYTES } from './packed';

/** Crashes in a row after which the page stops trying. */
const MOST_CRASHES = 3;

let worker: Worker | null = null;
let crashes = 0;
let ticket = 0;
/** Who waits for an answer, and what they get if the worker ends before. */
const waiting = new Map<number, { resolve(value: unknown): void; otherwise: unknown }>();
/** Who wants to see the frames as they come. */
const listeners = new Set<(snapshot: Snapshot, first: number) => void>();

export function start(): void {
  const own = new Worker(new URL('worker.js', import.meta.url), { type: 'module', name: 'odkit simulation' });
  worker = own;
  // One that was ended has nothing to say any more, even if it is on its way.
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

/** Something happens on the bench. */
export function act(input: Input): void {
  send({ op: 'do', input });
}

/** Asks the worker for something; `otherwise` is the answer when it ends before. */
export function ask<T>(make: (ticket: number) => Command, otherwise: T): Promise<T> {
  return new Promise((resolve) => {
    ticket += 1;
    waiting.set(ticket, { resolve: resolve as (value: unknown) => void, otherwise });
    send(make(ticket));
  });
}

/** Puts a device on the bus, begins a lesson, plays a script; what was there stays when it cannot be. */
export const add = (input: Extract<Input, { op: 'add' | 'lesson' | 'script' }>): Promise<Added> =>
  ask((ticket) => ({ op: 'do', input, ticket }), { node: null, diagnostics: [] });

/** Makes a run again, from nothing; a quiet one does not show what is sent at its first moment. */
export function restore(entries: Entry[], until: number, quiet = false): void {
  state.journal.entries = [];
  dropFrames();
  send({ op: 'restore', entries, until, quiet });
}

/** What makes an empty bench as this one is, without its past; null if nothing does. */
export const still = (): Promise<Entry[] | null> => ask((ticket) => ({ op: 'still', ticket }), null);

/** A DCF of a device as it is set up. */
export const exportDcf = (node: number): Promise<string | null> => ask((ticket) => ({ op: 'dcf', ticket, node }), null);

/** Asks the bus the same of several things. */
export const askEach = <K extends keyof Questions>(name: K, calls: Parameters<Questions[K]>[]): Promise<ReturnType<Questions[K]>[]> =>
  ask((ticket) => ({ op: 'ask', ticket, name, calls }), []);

/** Asks the bus; null where it ends before it answers. */
export const askBus = async <K extends keyof Questions>(name: K, ...args: Parameters<Questions[K]>): Promise<ReturnType<Questions[K]> | null> =>
  (await askEach(name, [args]))[0] ?? null;

/** Uses the whole module: what it says, or why it cannot. */
export const use = <K extends keyof Tools>(name: K, ...args: Parameters<Tools[K]>): Promise<{ value: ReturnType<Tools[K]> } | { error: string }> =>
  ask((ticket) => ({ op: 'tool', ticket, name, args }), { error: T.app.unloaded });

/** Calls `listener` with every snapshot, and the number of its first frame. */
export function listen(listener: (snapshot: Snapshot, first: number) => void): () => void {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

function receive(report: Report): void {
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
    case 'snapshot':
      apply(report.snapshot);
      requestAnimationFrame(() => send({ op: 'drawn' }));
      break;
    case 'crashed':
      crashed(report.message);
      break;
  }
}

/** Null: nobody will answer any more. */
function resolve(ticket: number, value: unknown): void {
  const asked = waiting.get(ticket);
  asked?.resolve(value ?? asked.otherwise);
  waiting.delete(ticket);
}

function devices(list: DeviceInfo[], lesson: Lesson | null): void {
  batch(() => {
    state.devices.value = list;
    state.lesson.value = lesson;
    if (!lesson) state.lessonState.value = null;
    if (state.selectedNode.value >= list.length) select(Math.max(0, list.length - 1));
    state.selected.value = null;
    state.values.value = new Map();
    state.lastPdo.value = null;
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
  const { ring } = state;
  let end = ring.end;
  while (end > ring.first && (ring.get(end - 1)?.time ?? 0) > to) end -= 1;
  ring.truncate(end);
  batch(() => {
    state.pausedAt.value = null;
    state.chosenFrame.value = null;
    state.captured.value = ring.end;
    state.cleared.value += 1;
  });
}

export function dropFrames(): void {
  state.ring.clear();
  batch(() => {
    state.chosenFrame.value = null;
    state.pausedAt.value = null;
    state.captured.value = state.ring.end;
    state.cleared.value += 1;
  });
}

function apply(snapshot: Snapshot): void {
  const first = state.ring.end;
  batch(() => {
    state.now.value = snapshot.now;
    state.rate.value = snapshot.rate;
    state.running.value = snapshot.running;
    state.replaying.value = snapshot.replaying;
    state.toSend.value = snapshot.toSend;
    state.statuses.value = snapshot.nodes;
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
    if (text) state.toast.value = { text, tone: 'error' };
  });
  for (const listener of listeners) listener(snapshot, first);
}

function frames(snapshot: Snapshot): void {
  const { ring } = state;
  ring.append(snapshot.frames);
  const node = state.nodeId.value;
  for (let number = ring.end - snapshot.frames.length / FRAME_BYTES; number < ring.end; number++) {
    const frame = ring.get(number);
    const isOurs = frame?.tag.text === 'PDO1' && frame.node === node && !frame.fromPage;
    if (isOurs) state.lastPdo.value = { time: frame.time, data: frame.data };
  }
  state.captured.value = ring.end;
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

/** A Rust panic ends the worker, not the page: a fresh one gets the same devices. */
function crashed(message: string): void {
  worker?.terminate();
  worker = null;
  crashes += 1;
  for (const { resolve, otherwise } of waiting.values()) resolve(otherwise);
  waiting.clear();
  if (crashes > MOST_CRASHES) {
    state.health.value = 'failed';
    state.toast.value = { text: T.app.crashed(message), tone: 'error' };
    return;
  }
  state.health.value = 'restarting';
  state.toast.value = { text: T.app.restarted(message), tone: 'error' };
  start();
  watch(watched, chosen);
  send({ op: 'speed', factor: state.speed.peek() });
  send({ op: 'select', node: state.selectedNode.peek() });
  state.journal.entries = [];
  // From the moment it stopped, so that time on the page does not run backwards.
  const at = state.now.peek();
  const entries = state.devices.peek().map(({ source, nodeId }): Entry => ({ at, input: { op: 'add', source, nodeId } }));
  send({ op: 'restore', entries, until: at, quiet: false });
  setTimeout(() => (crashes = 0), 10_000);
}
