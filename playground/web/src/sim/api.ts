// The seam between the page and the simulation: what a bus can do, and the messages
// that cross between the page and the worker. Only numbers, strings and plain records.

import type { Judgement, Lesson, LessonState } from '../wasm/od_playground';

/** What kind of value an object holds, by its CiA 301 name. */
export type TypeName = string;

export type Access = 'ro' | 'wo' | 'rw' | 'rwr' | 'rww' | 'const';

/** A value as the bus hands it over: 64-bit integers come as bigint. */
export type Value = number | bigint | string | boolean | Uint8Array | null;

/** One row of the object dictionary. */
export interface ObjectRecord {
  index: number;
  sub: number;
  /** The name of the object, or of the sub-object. */
  name: string;
  /** The name of the record or array that a sub-object belongs to. */
  parent: string | null;
  type: TypeName;
  /** Length in bits; 0 where it varies. */
  bits: number;
  access: Access;
  mappable: boolean;
  default: Value;
  low: Value;
  high: Value;
}

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

/** A fault in an EDS file, or something that deserves a look. */
export interface Diagnostic {
  code: string;
  severity: 'error' | 'warning' | 'info';
  message: string;
  /** How to mend it; empty if the message says so. */
  help: string;
  /** Counted from 1; 0 where something is missing altogether. */
  line: number;
  column: number;
  /** The object it is about, as `6004h`, or an empty string. */
  object: string;
}

export type Nmt = 'off' | 'initialising' | 'pre-operational' | 'operational' | 'stopped';

export type Lamp = 'off' | 'on' | 'flashing';

export interface Leds {
  green: Lamp;
  red: Lamp;
}

export interface Shaft {
  /** Revolutions since the zero point, with the fraction. */
  turns: number;
  rpm: number;
  /** What the sensor delivers, before scaling. */
  raw: number;
}

export type Condition = 'error active' | 'error passive' | 'bus-off';

/** What can be seen of a device from outside. */
export interface Status {
  nodeId: number;
  powered: boolean;
  nmt: Nmt;
  leds: Leds;
  shaft: Shaft | null;
  /** Rotary switches, 0 to 99. */
  nodeSwitch: number;
  /** DIP switches, 0 to 7. */
  rateSwitch: number;
  /** Bit rate in kbit/s since the last start; null where it adapts itself. */
  rate: number | null;
  /** Names of what can break. */
  canBreak: string[];
  /** Names of what is broken. */
  faults: string[];
  transmitErrors: number;
  receiveErrors: number;
  controller: Condition;
  /** Hangs on the line. */
  plugged: boolean;
  /** The shaft follows a profile. */
  moves: boolean;
}

/** The wire, and the controller of the page. */
export interface LineStatus {
  real: boolean;
  terminators: number;
  /** Bit rate of the page in kbit/s; null: that of the first device. */
  fixedRate: number | null;
  rate: number | null;
  transmitErrors: number;
  receiveErrors: number;
  controller: Condition;
  plugged: boolean;
}

export type { Judgement, Lesson, LessonState };

export type Source = { kind: 'builtin'; name: string } | { kind: 'eds'; name: string; text: string; lenient: boolean };

export interface Address {
  index: number;
  sub: number;
}

/** A device that needs no file. */
export interface Builtin {
  name: string;
  title: string;
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
  | { op: 'read'; ticket: number; addresses: Address[] }
  | { op: 'plot'; addresses: Address[] }
  | { op: 'look'; eeprom: boolean }
  | { op: 'describe'; ticket: number; frames: Uint8Array }
  | { op: 'layout'; ticket: number; frame: Uint8Array }
  | { op: 'judge'; ticket: number; answer: string; given: string }
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
  | { op: 'ready'; builtins: Builtin[] }
  | { op: 'added'; ticket: number; added: Added }
  | { op: 'devices'; devices: DeviceInfo[]; lesson: Lesson | null }
  /** Null: what was given is no frame. */
  | { op: 'judged'; ticket: number; judgement: Judgement | null }
  | { op: 'rewound'; to: number }
  | { op: 'snapshot'; snapshot: Snapshot }
  | { op: 'described'; ticket: number; words: string[] }
  | { op: 'laid'; ticket: number; layout: Uint32Array }
  | { op: 'values'; ticket: number; values: Value[] }
  | { op: 'stood'; ticket: number; entries: Entry[] | null }
  | { op: 'exported'; ticket: number; text: string | null }
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
  /** Of the selected node: values of the position chain, [6000h, 6001h, 6002h, 6004h, 6509h]. */
  chain: Value[] | null;
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

/** The objects between the shaft and the telegram. */
export const CHAIN: readonly Address[] = [0x6000, 0x6001, 0x6002, 0x6004, 0x6509].map((index) => ({ index, sub: 0 }));
