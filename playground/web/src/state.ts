// The state of the page, as signals. Reports of the worker change it (link.ts), views
// read it, actions go to the worker: data flows in one direction.

import { computed, signal } from '@preact/signals-core';
import type { RealState } from './real/api';
import type { Builtin, Chain, DeviceInfo, Diagnostic, Entry, Lesson, LessonState, LineStatus, ObjectRecord, Source, Status, Value } from './sim/api';
import { Ring } from './trace/ring';

type Health = 'starting' | 'running' | 'restarting' | 'failed';

export const health = signal<Health>('starting');
/** The devices on the bus, in the order of their numbers. */
export const devices = signal<DeviceInfo[]>([]);
/** The visible state of each. */
export const statuses = signal<Status[]>([]);
/** Number of the selected device. */
export const selectedNode = signal(0);
export const line = signal<LineStatus | null>(null);
/** Percentage of the last second in which a line with bit times was busy. */
export const load = signal(0);

export const device = computed<DeviceInfo | null>(() => devices.value[selectedNode.value] ?? null);
export const status = computed<Status | null>(() => statuses.value[selectedNode.value] ?? null);
export const source = computed<Source>(() => device.value?.source ?? { kind: 'builtin', name: 'gxmm' });
/** The built-in devices. */
export const builtins = signal<Builtin[]>([]);

export const now = signal(0);
export const running = signal(true);
export const speed = signal(1);
/** Virtual seconds per second. */
export const rate = signal(0);

/** A run is being repeated. */
export const replaying = signal(false);
/** Frames of a log that are not sent yet. */
export const toSend = signal(0);
/** A log that can be sent or played in the console; its frames are packed. */
export const log = signal<{ name: string; frames: Uint8Array; count: number } | null>(null);

export const powered = computed(() => status.value?.powered ?? false);
export const nmt = computed(() => status.value?.nmt ?? 'off');
export const nodeId = computed(() => status.value?.nodeId ?? device.value?.nodeId ?? 1);
export const shaft = computed(() => status.value?.shaft ?? null);
/** The run so far: all inputs with their times. */
export const journal: { entries: Entry[] } = { entries: [] };
export const journaled = signal(0);

/** The link to a real bus; null on the virtual bench. */
export const real = signal<RealState | null>(null);
/** Whether an added device describes a node; otherwise it is a virtual one. */
export const describes = signal(true);
/** Its dialog is open. */
export const realDialog = signal(false);

export const chain = signal<Chain | null>(null);
/** Data of the latest PDO1, with its moment. */
export const lastPdo = signal<{ time: number; data: Uint8Array } | null>(null);

/** Objects of the selected device whose value a power cycle would change. */
export const unsaved = signal<ReadonlySet<number>>(new Set());
/** The EEPROM of the selected device, while it is shown. */
export const eeprom = signal<Uint8Array | null>(null);

/** The frames that are shown; `captured` changes whenever the ring does. */
export const ring = new Ring();
/** Destination of new frames: another ring while a log is shown in place of the capture. */
export const live = { ring };
/** Whether a trigger has stopped the capture: new frames are dropped. */
export const capturing = signal(true);
/** State of a trigger, in words. */
export const trigger = signal<{ phase: 'armed' | 'fired' | 'stopped'; text: string } | null>(null);
export const captured = signal(0);
/** Number of the last frame that the console shows while it is paused. */
export const pausedAt = signal<number | null>(null);

/** Counts how often the capture was cleared. */
export const cleared = signal(0);

/** Numbers of frames that the user marked. */
export const bookmarks = signal<ReadonlySet<number>>(new Set());

/** Number of the frame that is shown in detail. */
export const chosenFrame = signal<number | null>(null);
/** A frame for the send line. */
export const draft = signal<{ text: string } | null>(null);

/** Live values of the watched objects, by `keyOf`. */
export const values = signal<ReadonlyMap<number, Value>>(new Map());
export const selected = signal<ObjectRecord | null>(null);
/** The saved value of the selected object; null if it is not saved. */
export const savedValue = signal<Value>(null);

/** The lesson in progress, and its current step. */
export const lesson = signal<Lesson | null>(null);
export const lessonState = signal<LessonState | null>(null);
/** Its name in the list or the address, how often it was started, and at which step. */
export const lessonRun = signal({ name: '', count: 0, step: 0 });
/** A lesson is being opened: until its state is there, the steps are those of the lesson before it. */
export const lessonOpening = signal(false);
/** Lessons that could not be opened, and the reasons. */
export const lessonFailed = signal<{ name: string; problems: Pick<Diagnostic, 'line' | 'message' | 'help'>[] }[]>([]);
export const lessonDialog = signal(false);
/** The address asks for the final test. */
export const finalTest = signal(false);
/** The fault case in the dialog of the lessons, with an empty name the list of all; null for the lessons. */
export const faultCase = signal<{ name: string; seed: number } | null>(null);
/** Wrong answers and opened hints of the step in progress. */
export const effort = signal({ wrong: 0, hints: 0 });
/** The student in a class, without a name until she has joined; null outside a class. */
export const member = signal<{ name: string; change(): void } | null>(null);

/** Whether the encoder is shown beside a lesson. */
export const encoderOpen = signal(false);

/** The step of the tour; null if there is none. */
export const tour = signal<number | null>(null);

/** The lab of the free bench that is open beside the bus, in the place of a lesson. */
export const lab = signal<'master' | 'line' | null>(null);

/** Whether a lesson or a lab is beside the bus. */
export const isBeside = computed(() => lab.value !== null || lesson.value !== null);

export type Tab = 'encoder' | 'console' | 'objects' | 'lesson';
export const tab = signal<Tab>('encoder');

/** A message. A message about a fault stays until it is closed or replaced. */
export const toast = signal<{ text: string; tone: 'info' | 'error'; action?: { text: string; run(): void } } | null>(null);

/** An offer of the page, shown once, until it is accepted or dismissed. */
export interface Offer {
  key: string;
  text: string;
  action: string;
  run(): void;
  /** Alternatives to it. */
  others?: { text: string; run(): void }[];
}
export const offers = signal<Offer[]>([]);

/** The place on the bus that the dialog fills; null while it is closed. */
export const deviceDialog = signal<number | 'new' | null>(null);
export const helpDialog = signal(false);
export const shareDialog = signal(false);
/** The PDO mapping that the editor opens, or 0 for 1A00h; null while it is closed. */
export const mappingDialog = signal<number | null>(null);
/** The device that was replaced last, and the journal entry that did it. */
export const replaced = signal<{ name: string; entry: number } | null>(null);

/** An EDS text for a place on the bus; `bytes`: the file that it was read from. */
export interface OpenedDevice {
  name: string;
  text: string;
  bytes?: Uint8Array;
  nodeId: number;
  place: number | 'new';
}

/** Content of the editor; `builtin`: the built-in device whose EDS it is; `at`: position of the cursor. */
export interface Editing extends OpenedDevice {
  builtin?: string;
  at: { line: number; character: number } | null;
}

/** An opened file, and its result; `device`: null if it is not an EDS. */
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
