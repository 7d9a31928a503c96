// What the page knows, as signals. The worker's reports change them (link.ts), views
// read them, actions go back to the worker: one way round.

import { computed, signal } from '@preact/signals-core';
import type { Builtin, Diagnostic, DeviceInfo, Leds, Nmt, ObjectRecord, Shaft, Source, Value } from './sim/api';
import { Ring } from './can/ring';

export type Health = 'starting' | 'running' | 'restarting' | 'failed';

export const health = signal<Health>('starting');
export const device = signal<DeviceInfo | null>(null);
export const source = signal<Source>({ kind: 'builtin', name: 'gxmm' });
/** The devices that need no file. */
export const builtins = signal<Builtin[]>([]);
export const diagnostics = signal<Diagnostic[]>([]);

export const now = signal(0);
export const running = signal(true);
export const speed = signal(1);
/** Virtual seconds per second. */
export const rate = signal(0);

export const powered = signal(false);
export const nmt = signal<Nmt>('off');
export const nodeId = signal(1);
export const leds = signal<Leds>({ green: 'off', red: 'off' });
export const shaft = signal<Shaft | null>(null);
export const chain = signal<Value[] | null>(null);
/** Data of the latest PDO1, with its moment. */
export const lastPdo = signal<{ time: number; data: Uint8Array } | null>(null);

/** Captured frames; `captured` changes whenever the ring does. */
export const ring = new Ring();
export const captured = signal(0);
/** Number of the frame after which the console stands still, while it is paused. */
export const pausedAt = signal<number | null>(null);

/** Counts how often the capture was cleared. */
export const cleared = signal(0);

/** Number of the frame that is shown in full. */
export const chosenFrame = signal<number | null>(null);
/** A frame that goes to the send line. */
export const draft = signal<{ text: string } | null>(null);

/** Live values of the watched objects, by `keyOf`. */
export const values = signal<ReadonlyMap<number, Value>>(new Map());
export const selected = signal<ObjectRecord | null>(null);

export type Tab = 'encoder' | 'console' | 'objects';
export const tab = signal<Tab>('encoder');

/** A message that goes away by itself. */
export const toast = signal<{ text: string; tone: 'info' | 'error' } | null>(null);

export const deviceDialog = signal(false);
export const helpDialog = signal(false);
/** A file that could not be opened, and why. */
export const attempt = signal<{ name: string; text: string; diagnostics: Diagnostic[] } | null>(null);

export const keyOf = (index: number, sub: number): number => index * 256 + sub;

export const objectsByKey = computed<ReadonlyMap<number, ObjectRecord>>(
  () => new Map((device.value?.objects ?? []).map((object) => [keyOf(object.index, object.sub), object])),
);
