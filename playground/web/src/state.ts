// What the page knows, as signals. The worker's reports change them (link.ts), views
// read them, actions go back to the worker: one way round.

import { computed, signal } from '@preact/signals-core';
import type { RealState } from './real/api';
import type { Builtin, Chain, DeviceInfo, Diagnostic, Entry, Lesson, LessonState, LineStatus, ObjectRecord, Source, Status, Value } from './sim/api';
import { Ring } from './trace/ring';

export type Health = 'starting' | 'running' | 'restarting' | 'failed';

export const health = signal<Health>('starting');
/** What is on the bus, in the order of its numbers. */
export const devices = signal<DeviceInfo[]>([]);
/** What can be seen of each. */
export const statuses = signal<Status[]>([]);
/** Number of the device that the panels show. */
export const selectedNode = signal(0);
export const line = signal<LineStatus | null>(null);
/** Per cent of the time that a line which takes time was busy in the last second. */
export const load = signal(0);

export const device = computed<DeviceInfo | null>(() => devices.value[selectedNode.value] ?? null);
export const status = computed<Status | null>(() => statuses.value[selectedNode.value] ?? null);
export const source = computed<Source>(() => device.value?.source ?? { kind: 'builtin', name: 'gxmm' });
/** The devices that need no file. */
export const builtins = signal<Builtin[]>([]);

export const now = signal(0);
export const running = signal(true);
export const speed = signal(1);
/** Virtual seconds per second. */
export const rate = signal(0);

/** A run is made again and is not there yet. */
export const replaying = signal(false);
/** Frames of a log that are still to be sent. */
export const toSend = signal(0);
/** A log that can be sent, or played to be looked at; its frames are packed. */
export const log = signal<{ name: string; frames: Uint8Array; count: number } | null>(null);

export const powered = computed(() => status.value?.powered ?? false);
export const nmt = computed(() => status.value?.nmt ?? 'off');
export const nodeId = computed(() => status.value?.nodeId ?? device.value?.nodeId ?? 1);
export const shaft = computed(() => status.value?.shaft ?? null);
/** The run so far: everything that was done, with its moment. */
export const journal: { entries: Entry[] } = { entries: [] };
export const journaled = signal(0);

/** The link to a real bus; null on the virtual bench. */
export const real = signal<RealState | null>(null);
/** A device that comes to it describes a node; else it is a virtual one. */
export const describes = signal(true);
/** Its dialog is open. */
export const realDialog = signal(false);

export const chain = signal<Chain | null>(null);
/** Data of the latest PDO1, with its moment. */
export const lastPdo = signal<{ time: number; data: Uint8Array } | null>(null);

/** Objects of the selected device that a power cycle would change. */
export const unsaved = signal<ReadonlySet<number>>(new Set());
/** The EEPROM of the selected device, while it is shown. */
export const eeprom = signal<Uint8Array | null>(null);

/** The frames that are shown; `captured` changes whenever the ring does. */
export const ring = new Ring();
/** Where new frames go: another ring while a log is shown in the place of the capture. */
export const live = { ring };
/** A trigger stops the capture: new frames go nowhere. */
export const capturing = signal(true);
/** What a trigger is doing, in words. */
export const trigger = signal<{ phase: 'armed' | 'fired' | 'stopped'; text: string } | null>(null);
export const captured = signal(0);
/** Number of the last frame that the console shows while it is paused. */
export const pausedAt = signal<number | null>(null);

/** Counts how often the capture was cleared. */
export const cleared = signal(0);

/** Numbers of frames that the user marked. */
export const bookmarks = signal<ReadonlySet<number>>(new Set());

/** Number of the frame that is shown in full. */
export const chosenFrame = signal<number | null>(null);
/** A frame that goes to the send line. */
export const draft = signal<{ text: string } | null>(null);

/** Live values of the watched objects, by `keyOf`. */
export const values = signal<ReadonlyMap<number, Value>>(new Map());
export const selected = signal<ObjectRecord | null>(null);
/** What the EEPROM holds for the selected object; null if it is not saved. */
export const savedValue = signal<Value>(null);

/** The lesson in progress, and its current step. */
export const lesson = signal<Lesson | null>(null);
export const lessonState = signal<LessonState | null>(null);
/** What it is called in the list or the address, how often one was begun, and at which step. */
export const lessonRun = signal({ name: '', count: 0, step: 0 });
/** A lesson that could not be opened, and why. */
export const lessonFailed = signal<{ name: string; problems: Diagnostic[] } | null>(null);
export const lessonDialog = signal(false);

/** The encoder is unfolded beside a lesson. */
export const encoderOpen = signal(false);

/** The step of the tour; null without a tour. */
export const tour = signal<number | null>(null);

export type Tab = 'encoder' | 'console' | 'objects' | 'lesson';
export const tab = signal<Tab>('encoder');

/** A message. One about a fault stays until it is closed or another comes. */
export const toast = signal<{ text: string; tone: 'info' | 'error'; action?: { text: string; run(): void } } | null>(null);

/** An offer of the page, shown once, until it is accepted or dismissed. */
export interface Offer {
  key: string;
  text: string;
  action: string;
  run(): void;
  /** Other ways to take it. */
  others?: { text: string; run(): void }[];
}
export const offers = signal<Offer[]>([]);

/** Which place on the bus the dialog fills; null while it is closed. */
export const deviceDialog = signal<number | 'new' | null>(null);
export const helpDialog = signal(false);
export const shareDialog = signal(false);
/** The PDO mapping that the editor opens with, 1A00h if it is 0; null while it is closed. */
export const mappingDialog = signal<number | null>(null);
/** The device that another took the place of last, and the entry of the journal that did it. */
export const replaced = signal<{ name: string; entry: number } | null>(null);

/** An EDS text for a place on the bus; `bytes`: the file that it comes from. */
export interface OpenedDevice {
  name: string;
  text: string;
  bytes?: Uint8Array;
  nodeId: number;
  place: number | 'new';
}

/** What the editor opens; `builtin`: the device of ours whose EDS it is; `at`: where its cursor goes. */
export interface Editing extends OpenedDevice {
  builtin?: string;
  at: { line: number; character: number } | null;
}

/** A file that was opened, and what came of it; `device`: null where it is not an EDS. */
export interface Opened {
  name: string;
  said: string;
  isBad: boolean;
  device: OpenedDevice | null;
  action?: { text: string; run(): void };
}
export const report = signal<Opened | null>(null);
export const editing = signal<Editing | null>(null);

export const keyOf = (index: number, sub: number): number => index * 256 + sub;

export const objectsByKey = computed<ReadonlyMap<number, ObjectRecord>>(
  () => new Map((device.value?.objects ?? []).map((object) => [keyOf(object.index, object.sub), object])),
);
