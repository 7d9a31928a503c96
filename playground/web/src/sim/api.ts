// The seam between the page and the simulation: what a bus can do, and the messages
// that cross between the page and the worker. Only numbers, strings and plain records.

import type { Builtin, Bus, Chain, decodeEds, Diagnostic, judgeAnswer, Lesson, LessonState, LineStatus, ObjectRecord, readLog, Status, Value, writeLog } from '../wasm/od_playground';

export type { Builtin, Chain, Diagnostic, Field, FrameTemplate, Judgement, Lamp, Lesson, LessonState, LineStatus, Log, Mapped, MappingStep, ObjectRecord, Outcome, Pdo, Status, Transfer, Value } from '../wasm/od_playground';

export interface DeviceInfo {
  /** Short name: `gxmm`, or the file's product name. */
  name: string;
  /** One line for people. */
  title: string;
  /** The node ID that it was put on the bus with. */
  nodeId: number;
  source: Source;
  objects: ObjectRecord[];
}

export type Source = { kind: 'builtin'; name: string } | { kind: 'eds'; name: string; text: string; lenient: boolean };

export interface Address {
  index: number;
  sub: number;
}

/**
 * What changes the simulation. The journal keeps every one with its virtual moment, so
 * that a run can be made again: for a step back, for a link, after a reload.
 */
export type Input =
  | { op: 'add'; source: Source; nodeId: number; place?: number }
  | { op: 'remove'; node: number }
  | { op: 'send'; id: number; data: Uint8Array; extended: boolean; remote: boolean }
  | { op: 'repeat'; key: number; id: number; data: Uint8Array; extended: boolean; remote: boolean; micros: number }
  | { op: 'power'; node: number; on: boolean }
  | { op: 'turn'; node: number; turns: number }
  | { op: 'rpm'; node: number; rpm: number }
  | { op: 'follow'; node: number; steps: number[]; repeats: boolean }
  | { op: 'switches'; node: number; id?: number; dip?: { bit: number; on: boolean } }
  | { op: 'fault'; node: number; name: string; on: boolean }
  | { op: 'line'; real: boolean; terminators: number; rate: number | null }
  | { op: 'seed'; seed: number }
  | { op: 'plug'; station: number; on: boolean }
  | { op: 'restart'; station: number }
  | { op: 'cut'; node: number; bytes: number }
  | { op: 'eeprom'; node: number; bytes: Uint8Array }
  /** A frame for one device alone, beside the wire. */
  | { op: 'deliver'; node: number; id: number; data: Uint8Array }
  /** Its bench takes the place of all that was there. */
  | { op: 'lesson'; text: string }
  | { op: 'leave' }
  /** Lines of a script, such as the solution of a step. */
  | { op: 'script'; text: string };

/** An input and its virtual moment in microseconds. */
export interface Entry {
  at: number;
  input: Input;
}

/** What the page asks of the bus: it changes nothing. */
export type Questions = Pick<Bus, 'describeAll' | 'fields' | 'mappingSteps' | 'pdos' | 'read'>;

/** What the whole module does without a bus. */
export interface Tools {
  decodeEds: typeof decodeEds;
  judgeAnswer: typeof judgeAnswer;
  readLog: typeof readLog;
  writeLog: typeof writeLog;
}

/** What the page asks of the worker. */
export type Command =
  | { op: 'do'; input: Input; ticket?: number }
  /** `quiet`: what is sent at the first moment is not shown. */
  | { op: 'restore'; entries: Entry[]; until: number; quiet: boolean }
  | { op: 'still'; ticket: number }
  | { op: 'dcf'; ticket: number; node: number }
  | { op: 'run'; running: boolean }
  | { op: 'speed'; factor: number }
  | { op: 'step'; micros: number; frames: number }
  | { op: 'back'; to: number }
  | { op: 'select'; node: number }
  /** `chosen`: the one whose saved value is wanted, too. */
  | { op: 'watch'; addresses: Address[]; chosen: Address | null }
  | { op: 'plot'; addresses: Address[] }
  | { op: 'look'; eeprom: boolean }
  /** Reads an object over the bus, or writes it where there are bytes. */
  | { op: 'transfer'; ticket: number; node: number; index: number; sub: number; bytes: Uint8Array | null }
  /** Each call has its own arguments. */
  | { op: 'ask'; ticket: number; name: keyof Questions; calls: unknown[][] }
  | { op: 'tool'; ticket: number; name: keyof Tools; args: unknown[] }
  | { op: 'replay'; frames: Uint8Array; speed: number }
  | { op: 'drawn' };

/** What came of an input that puts a device on the bus, begins a lesson, or plays a script. */
export interface Added {
  /** Its number, or null where it cannot run. */
  node: number | null;
  diagnostics: Diagnostic[];
}

/** What the worker tells the page. */
export type Report =
  | { op: 'ready'; builtins: Builtin[]; module: WebAssembly.Module }
  /** What came of a command with this ticket. */
  | { op: 'answer'; ticket: number; value: unknown }
  | { op: 'devices'; devices: DeviceInfo[]; lesson: Lesson | null }
  | { op: 'rewound'; to: number }
  | { op: 'snapshot'; snapshot: Snapshot }
  | { op: 'crashed'; message: string };

/** The state of everything at one virtual moment. */
export interface Snapshot {
  now: number;
  running: boolean;
  /** It makes a run again and is not there yet. */
  replaying: boolean;
  /** Frames of a log that are still to be sent. */
  toSend: number;
  /** Virtual seconds per second, as measured. */
  rate: number;
  nodes: Status[];
  line: LineStatus;
  /** How far the lesson is. */
  lesson: LessonState | null;
  /** New frames, packed. */
  frames: Uint8Array;
  /** The words of the last frames of the batch. */
  words: string[];
  /** The journal from here on has changed. */
  journal: { from: number; entries: Entry[] } | null;
  /** Of the selected node: from the raw position to the position value; null without a shaft. */
  chain: Chain | null;
  /** Of the selected node: values of the watched objects, when they were read again. */
  values: Value[] | null;
  /** Of the selected node: what the EEPROM holds for the chosen object; with the values. */
  saved: Value;
  /** Of the selected node: objects that are not saved as they are, as `index * 256 + sub`; with the values. */
  unsaved: Uint32Array | null;
  /** Of the selected node: the bytes of its EEPROM, while somebody looks. */
  eeprom: Uint8Array | null;
  /** Values of the plotted objects, and whose they are: others may be wanted by now. */
  plot: { node: number; addresses: Address[]; values: Value[] } | null;
}
