// The seam between the page and the simulation: what a bus can do, and the messages
// that cross between the page and the worker. Only numbers, strings and plain records.

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
  nodeId: number;
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

/** A device that could be opened or could not. */
export type Opened = { device: DeviceInfo; diagnostics: Diagnostic[] } | { device: null; diagnostics: Diagnostic[] };

/** A CAN bus with one simulated device on it. */
export interface Bus {
  /** Puts a device of ours on the bus, powered. */
  openBuiltin(name: string, nodeId: number): Opened;
  /** Puts the device that an EDS file describes on the bus, powered; a lenient bus runs what it can of a text with errors. */
  openEds(text: string, nodeId: number, lenient: boolean): Opened;
  /** Sends a frame at the present moment. */
  send(id: number, data: Uint8Array, extended: boolean, remote: boolean): void;
  /** Lets at most `micros` pass, or less when `maxFrames` were seen; answers with what passed. */
  advance(micros: number, maxFrames: number): number;
  /** Virtual microseconds since the bus was made. */
  now(): number;
  /** How many frames wait to be drained. */
  pending(): number;
  /** All frames since the last call, packed (see packed.ts). */
  drain(): Uint8Array;
  /** One packed frame in plain words. */
  describe(frame: Uint8Array): string;
  /** The value of an object, without a frame on the bus. */
  read(index: number, sub: number): Value;
  nmt(): Nmt;
  leds(): Leds;
  nodeId(): number;
  builtins(): Builtin[];
  setPower(on: boolean): void;
  powered(): boolean;
  shaft(): Shaft | null;
  setRpm(rpm: number): void;
  turnTo(turns: number): void;
}

/** What the page asks of the worker. */
export type Command =
  | { op: 'open'; source: Source; nodeId: number }
  | { op: 'send'; id: number; data: Uint8Array; extended: boolean; remote: boolean }
  | { op: 'run'; running: boolean }
  | { op: 'speed'; factor: number }
  | { op: 'step'; micros: number }
  | { op: 'power'; on: boolean }
  | { op: 'turn'; turns: number }
  | { op: 'rpm'; rpm: number }
  | { op: 'watch'; addresses: Address[] }
  | { op: 'describe'; ticket: number; frames: Uint8Array }
  | { op: 'drawn' };

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

/** What the worker tells the page. */
export type Report =
  | { op: 'ready'; builtins: Builtin[] }
  | { op: 'opened'; source: Source; result: Opened }
  | { op: 'snapshot'; snapshot: Snapshot }
  | { op: 'described'; ticket: number; words: string[] }
  | { op: 'crashed'; message: string };

/** The state of everything at one virtual moment. */
export interface Snapshot {
  now: number;
  running: boolean;
  /** Virtual seconds per second, as measured. */
  rate: number;
  powered: boolean;
  nmt: Nmt;
  nodeId: number;
  leds: Leds;
  shaft: Shaft | null;
  /** New frames, packed. */
  frames: Uint8Array;
  /** The words of the last frames of the batch. */
  words: string[];
  /** Values of the position chain: [6000h, 6001h, 6002h, 6004h, 6509h]. */
  chain: Value[] | null;
  /** Values of the watched objects, when they were read again. */
  values: Value[] | null;
}

/** The objects between the shaft and the telegram. */
export const CHAIN: readonly Address[] = [0x6000, 0x6001, 0x6002, 0x6004, 0x6509].map((index) => ({ index, sub: 0 }));
