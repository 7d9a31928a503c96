// The page's end of the worker. It starts it, starts it again after a crash, and
// turns its reports into state.

import { batch } from '@preact/signals-core';
import * as state from '../state';
import { frameArrived, tick } from './client';
import { noteWords } from './words';
import type { Command, Opened, Report, Snapshot, Source } from './api';
import { FRAME_BYTES, unpack } from './packed';

/** Crashes in a row after which the page stops trying. */
const MOST_CRASHES = 3;

let worker: Worker | null = null;
let crashes = 0;
let ticket = 0;
const tickets = new Map<number, (words: string[]) => void>();
let openings: ((result: Opened) => void)[] = [];
let current: { source: Source; nodeId: number } | null = null;

export function start(): void {
  const own = new Worker(new URL('worker.js', import.meta.url), { type: 'module', name: 'odkit simulation' });
  worker = own;
  // One that was ended has nothing to say any more, even if it is on its way.
  own.onmessage = ({ data }: MessageEvent<Report>) => {
    if (own === worker) receive(data);
  };
  own.onerror = (event) => {
    event.preventDefault();
    if (own === worker) crashed(event.message || 'the worker could not be loaded');
  };
}

export function send(command: Command): void {
  worker?.postMessage(command);
}

/** Opens a device; the device before stays when the new one cannot be opened. */
export function open(source: Source, nodeId: number): Promise<Opened> {
  return new Promise((resolve) => {
    openings.push(resolve);
    send({ op: 'open', source, nodeId });
    state.nodeId.value = nodeId;
  });
}

/** The words of packed frames. */
export function describe(frames: Uint8Array): Promise<string[]> {
  return new Promise((resolve) => {
    ticket += 1;
    tickets.set(ticket, resolve);
    send({ op: 'describe', ticket, frames });
  });
}

function receive(report: Report): void {
  switch (report.op) {
    case 'ready':
      state.health.value = 'running';
      state.builtins.value = report.builtins;
      break;
    case 'opened':
      opened(report.source, report.result);
      break;
    case 'snapshot':
      apply(report.snapshot);
      requestAnimationFrame(() => send({ op: 'drawn' }));
      break;
    case 'described':
      tickets.get(report.ticket)?.(report.words);
      tickets.delete(report.ticket);
      break;
    case 'crashed':
      crashed(report.message);
      break;
  }
}

function opened(source: Source, result: Opened): void {
  const { device, diagnostics } = result;
  if (device) {
    current = { source, nodeId: device.nodeId };
    document.title = `${device.name} – odkit`;
    batch(() => {
      state.device.value = device;
      state.source.value = source;
      state.diagnostics.value = diagnostics;
      state.selected.value = null;
      state.values.value = new Map();
      state.lastPdo.value = null;
    });
  }
  openings.shift()?.(result);
}

function apply(snapshot: Snapshot): void {
  batch(() => {
    state.now.value = snapshot.now;
    state.rate.value = snapshot.rate;
    state.running.value = snapshot.running;
    state.powered.value = snapshot.powered;
    state.nmt.value = snapshot.nmt;
    if (snapshot.powered) state.nodeId.value = snapshot.nodeId;
    const { green, red } = state.leds.peek();
    if (green !== snapshot.leds.green || red !== snapshot.leds.red) state.leds.value = snapshot.leds;
    state.shaft.value = snapshot.shaft;
    state.chain.value = snapshot.chain;
    if (snapshot.values) watchedValues(snapshot);
    if (snapshot.frames.length > 0) frames(snapshot);
    tick(snapshot.now);
  });
}

function frames(snapshot: Snapshot): void {
  const { ring } = state;
  ring.append(snapshot.frames);
  noteWords(ring.end - snapshot.words.length, snapshot.words);
  const pdo = 0x180 + snapshot.nodeId;
  for (let at = 0; at < snapshot.frames.length; at += FRAME_BYTES) {
    const frame = unpack(snapshot.frames, at);
    if (frame.fromPage) continue;
    if (frame.id === pdo) state.lastPdo.value = { time: frame.time, data: frame.data };
    else frameArrived(frame);
  }
  state.captured.value = ring.end;
}

let watched: { index: number; sub: number }[] = [];

/** The objects whose values are shown. */
export function watch(addresses: { index: number; sub: number }[]): void {
  watched = addresses;
  send({ op: 'watch', addresses });
}

function watchedValues(snapshot: Snapshot): void {
  const fresh = snapshot.values;
  if (!fresh || fresh.length !== watched.length) return;
  const map = new Map(state.values.peek());
  watched.forEach(({ index, sub }, i) => map.set(state.keyOf(index, sub), fresh[i] ?? null));
  state.values.value = map;
}

/** A Rust panic ends the worker, not the page: a fresh one opens the same device. */
function crashed(message: string): void {
  worker?.terminate();
  worker = null;
  crashes += 1;
  tickets.clear();
  openings = [];
  if (crashes > MOST_CRASHES) {
    state.health.value = 'failed';
    state.toast.value = { text: `The simulation stopped: ${message}`, tone: 'error' };
    return;
  }
  state.health.value = 'restarting';
  state.toast.value = { text: `The simulation stopped (${message}) and was started again.`, tone: 'error' };
  start();
  watch(watched);
  send({ op: 'speed', factor: state.speed.peek() });
  if (current) void open(current.source, current.nodeId);
  setTimeout(() => (crashes = 0), 10_000);
}
