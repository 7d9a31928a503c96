// The page's side of a real bus: it opens and closes one, keeps the content of the virtual bench, and
// owns the serial port.

import { ask, dropFrames, hooks, select, send, use } from '../sim/link';
import * as state from '../state';
import { download } from '../actions';
import { effect, signal } from '@preact/signals-core';
import type { Ring } from '../trace/ring';
import { R } from './texts';
import type { RealCommand, RealReport, Target, Why } from './api';

const tell = (what: RealCommand): void => send({ op: 'real', what });

/** Stored settings of the last connection. */
export interface Last {
  address: string;
  rate: number;
  baud: number;
  along: boolean;
}

const KEPT = 'odkit.connect';
const NOTHING: Last = { address: '', rate: 500, baud: 115_200, along: false };

export function last(): Last {
  try {
    return { ...NOTHING, ...(JSON.parse(localStorage.getItem(KEPT) ?? '{}') as Partial<Last>) };
  } catch {
    return NOTHING;
  }
}

function remember(change: Partial<Last>): void {
  try {
    localStorage.setItem(KEPT, JSON.stringify({ ...last(), ...change }));
  } catch {
    // Storage is not allowed: the user types it again.
  }
}

/** Reason why the last attempt failed; empty if it did not fail. */
export const problem = signal('');
export const isConnecting = signal(false);

/** The address as a WebSocket URL, from what odkit prints, from `--link`, or from `HOST:PORT`. */
function addressOf(text: string): { address: string; name: string } | { error: string } {
  const trimmed = text.trim();
  if (trimmed === '') return { error: R.bad.empty };
  let url: URL;
  try {
    url = new URL(trimmed.replace(/^(ws:)?(\/\/)?/i, 'http://'));
  } catch {
    return { error: R.bad.wrong };
  }
  // A policy cannot name the IPv6 address.
  if (url.hostname === '[::1]') url.hostname = 'localhost';
  if (!['127.0.0.1', 'localhost'].includes(url.hostname)) return { error: /^[\d.]+$|\./.test(url.hostname) || url.port ? R.bad.far : R.bad.wrong };
  if (!url.searchParams.get('token')) return { error: R.bad.noToken };
  return { address: url.href.replace(/^http/, 'ws'), name: url.host };
}

export async function connectTo(text: string, along: boolean): Promise<boolean> {
  const to = addressOf(text);
  if ('error' in to) {
    problem.value = to.error;
    return false;
  }
  remember({ address: text.trim(), along });
  return connect({ kind: 'ws', ...to }, along);
}

async function connect(to: Target, along: boolean): Promise<boolean> {
  problem.value = '';
  isConnecting.value = true;
  const from = state.real.peek() ? virtual : keep();
  const wanted = from.devices.filter(({ source, name }) => source.kind !== 'builtin' || name === source.name);
  const devices = along ? wanted.map(({ source, nodeId }) => ({ source, nodeId })) : [];
  const came = await ask<Why | { kind: 'open' }>((ticket) => ({ op: 'real', what: { is: 'connect', ticket, to, devices } }), { kind: 'gone' });
  isConnecting.value = false;
  if (came.kind === 'open') return true;
  problem.value = R.why(came, to.name, to.kind === 'serial');
  return false;
}

/** Ends an attempt or the connection; the virtual bench continues. */
export function leave(): void {
  tell({ is: 'leave' });
  void closePort();
}

export const setSending = (on: boolean): void => tell({ is: 'sending', on });

export async function again(): Promise<void> {
  if (state.real.peek()?.kind === 'serial' && !(await reopen())) return;
  tell({ is: 'again' });
}

export const identify = (vendor: number, product: number): Promise<string | null> =>
  ask((ticket) => ({ op: 'real', what: { is: 'identify', ticket, vendor, product } }), null);

// ---- Content of the virtual bench ----

const all = (ring: Ring): Uint8Array => ring.slice(ring.first, ring.end);

const keep = () => ({
  devices: state.devices.peek(),
  node: state.selectedNode.peek(),
  now: state.now.peek(),
  frames: all(state.live.ring),
});
let virtual = keep();

hooks.real = (report: RealReport): void => {
  switch (report.tells) {
    case 'bytes':
      write(report.bytes);
      break;
    case 'begun':
      virtual = keep();
      dropFrames();
      select(0);
      state.tour.value = null;
      state.tab.value = 'console';
      document.documentElement.dataset['real'] = '';
      break;
    case 'left':
      if ('real' in document.documentElement.dataset) left();
      break;
  }
};

hooks.crashed = left;
hooks.held = () => (state.toast.value = { text: R.held, tone: 'error', action: { text: R.turnOn, run: () => setSending(true) } });

function left(): void {
  const frames = all(state.live.ring);
  delete document.documentElement.dataset['real'];
  state.real.value = null;
  state.now.value = virtual.now;
  dropFrames();
  state.ring.append(virtual.frames);
  state.captured.value = state.ring.end;
  select(virtual.node);
  const count = frames.length / 24;
  state.toast.value = count
    ? { text: R.leftWith(count), tone: 'info', action: { text: R.save, run: () => void save(frames) } }
    : { text: R.left, tone: 'info' };
}

async function save(frames: Uint8Array): Promise<void> {
  const file = await use('writeLog', 'log', frames);
  if ('value' in file) download(file.value as Uint8Array<ArrayBuffer>, 'odkit-bus.log');
}

// ---- The serial port ----

interface SerialPort extends EventTarget {
  readable: ReadableStream<Uint8Array> | null;
  writable: WritableStream<Uint8Array> | null;
  open(options: { baudRate: number }): Promise<void>;
  close(): Promise<void>;
}

interface Serial extends EventTarget {
  requestPort(): Promise<SerialPort>;
}

const serial = (): Serial | undefined => (navigator as Navigator & { serial?: Serial }).serial;
export const hasSerial = (): boolean => serial() !== undefined;

/** Maximum number of bytes that wait for a port. */
const MOST_WAITING = 256 * 1024;

let port: SerialPort | null = null;
let baud = NOTHING.baud;
let reader: ReadableStreamDefaultReader<Uint8Array> | null = null;
let writer: WritableStreamDefaultWriter<Uint8Array> | null = null;
let waiting = 0;

/** Lets the user choose an adapter, and opens its bus. */
export async function connectAdapter(rate: number, speed: number, along: boolean): Promise<boolean> {
  remember({ rate, baud: speed, along });
  problem.value = '';
  try {
    const chosen = await serial()!.requestPort();
    await closePort();
    port = chosen;
    baud = speed;
    await openPort();
  } catch (error) {
    const isClosed = error instanceof DOMException && error.name === 'NotFoundError';
    problem.value = isClosed ? R.notChosen : R.bad.port(error instanceof Error ? error.message : String(error));
    return false;
  }
  const isOpen = await connect({ kind: 'serial', rate: rate || null, name: R.serial }, along);
  if (!isOpen) await closePort();
  return isOpen;
}

async function openPort(): Promise<void> {
  const own = port!;
  await own.open({ baudRate: baud });
  waiting = 0;
  writer = own.writable!.getWriter();
  // An unplugged port ends both; the reader reports it.
  writer.closed.catch(() => undefined);
  void read(own);
}

async function read(own: SerialPort): Promise<void> {
  // After an overrun or a parity error the port has a new stream.
  while (own === port && own.readable) {
    const mine = own.readable.getReader();
    reader = mine;
    try {
      for (;;) {
        const { value, done } = await mine.read();
        if (done) break;
        tell({ is: 'bytes', bytes: value });
      }
    } catch (error) {
      const goesOn = error instanceof DOMException && ['BufferOverrunError', 'FramingError', 'ParityError', 'BreakError'].includes(error.name);
      if (!goesOn) break;
    } finally {
      mine.releaseLock();
    }
    if (reader !== mine) return;
    if (!own.readable) break;
  }
  if (own === port && writer) gone();
}

/** The adapter was unplugged. */
function gone(): void {
  writer?.releaseLock();
  reader = writer = null;
  void port?.close().catch(() => undefined);
  tell({ is: 'gone' });
}

function write(bytes: Uint8Array): void {
  if (!writer || waiting > MOST_WAITING) return tell({ is: 'unsent', bytes });
  waiting += bytes.length;
  writer.write(bytes).then(
    () => (waiting -= bytes.length),
    () => tell({ is: 'unsent', bytes }),
  );
}

async function closePort(): Promise<void> {
  const own = port;
  const [oldReader, oldWriter] = [reader, writer];
  port = reader = writer = null;
  await oldReader?.cancel().catch(() => undefined);
  oldWriter?.releaseLock();
  await own?.close().catch(() => undefined);
}

async function reopen(): Promise<boolean> {
  try {
    await port?.close().catch(() => undefined);
    await openPort();
    return true;
  } catch {
    return false;
  }
}

// An adapter that is plugged in again continues.
serial()?.addEventListener('connect', () => {
  if (state.real.peek()?.status === 'lost') void again();
});
serial()?.addEventListener('disconnect', ({ target }) => {
  if (target === port && writer) gone();
});

// The title of the tab shows it, too.
effect(() => {
  const isReal = state.real.value !== null;
  void state.devices.value;
  queueMicrotask(() => (document.title = document.title.replace(/^(● )?/, isReal ? '● ' : '')));
});
