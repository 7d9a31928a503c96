// The seam between the page and the simulation: what a bus can do, and the messages
// that cross between the page and the worker. Only numbers, strings and plain records.

import type { RealCommand, RealReport, RealState } from '../real/api';
import type { Builtin, Bus, Chain, decodeEds, DeviceInfo, Entry, Input, JournalNews, judgeAnswer, Lesson, LessonState, LineStatus, plainEds, readLog, Status, Value, writeLog } from '../wasm/od_playground';

export type { Added, Builtin, Chain, DeviceInfo, Diagnostic, Entry, Field, FrameTemplate, Input, Judgement, Lamp, Lesson, LessonState, LineStatus, Log, Mapped, MappingStep, ObjectRecord, Outcome, Pdo, Source, Status, Transfer, Value } from '../wasm/od_playground';

export interface Address {
  index: number;
  sub: number;
}

/** What the page asks of the bus: it changes nothing. */
export type Questions = Pick<Bus, 'describeAll' | 'fields' | 'mappingSteps' | 'pdos' | 'read'>;

/** What the whole module does without a bus. */
export interface Tools {
  decodeEds: typeof decodeEds;
  judgeAnswer: typeof judgeAnswer;
  plainEds: typeof plainEds;
  readLog: typeof readLog;
  writeLog: typeof writeLog;
}

/** What the page asks of the worker. */
export type Command =
  | { op: 'do'; input: Input; ticket?: number }
  /** `quiet`: what is sent at the first moment is not shown; `waits`: what comes next waits until it is there. */
  | { op: 'restore'; entries: Entry[]; until: number; quiet: boolean; waits?: boolean }
  | { op: 'still'; ticket: number }
  | { op: 'dcf'; ticket: number; node: number }
  | { op: 'run'; running: boolean }
  | { op: 'speed'; factor: number }
  | { op: 'step'; micros: number; frames: number }
  /** To a moment, what came after comes again; or to the one before an entry of the journal, for good. */
  | { op: 'back'; to: number }
  | { op: 'back'; to: null; entry: number; ticket: number }
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
  | { op: 'replay'; ticket: number; frames: Uint8Array; speed: number; paused: boolean }
  /** Of the log that is sent: another speed, a pause or its end, the next frame now, or no more. */
  | { op: 'player'; speed?: number; paused?: boolean; steps?: boolean; ends?: boolean }
  /** About a real bus. */
  | { op: 'real'; what: RealCommand }
  | { op: 'drawn' }
  /** Answered at once, whatever else there is to do. */
  | { op: 'ping' };

/** What the worker tells the page. */
export type Report =
  | { op: 'ready'; builtins: Builtin[]; module: WebAssembly.Module }
  /** What came of a command with this ticket. */
  | { op: 'answer'; ticket: number; value: unknown }
  | { op: 'devices'; devices: DeviceInfo[]; lesson: Lesson | null }
  | { op: 'rewound'; to: number }
  | { op: 'real'; what: RealReport }
  | { op: 'pong' }
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
  /** The link to a real bus; null on the virtual bench. */
  real: RealState | null;
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
  /** What happened to EEPROMs: damage, saves that were cut. */
  notices: string[];
  /** The journal from here on has changed. */
  journal: JournalNews | null;
  /** Of the selected node: from the raw position to the position value; null without a shaft. */
  chain: Chain | null;
  /** Of the selected node: values of the watched objects, when they were read again. */
  values: Value[] | null;
  /** Of the selected node: what the EEPROM holds for the chosen object; with the values. */
  saved: Value;
  /** Of the selected node: objects that are not saved as they are, as `index * 256 + sub`; with the values. */
  unsaved: Uint32Array | null;
  /** Of the selected node: the bytes of its EEPROM, while they are shown. */
  eeprom: Uint8Array | null;
  /** Values of the plotted objects, and whose they are: others may be wanted by now. */
  plot: { node: number; addresses: Address[]; values: Value[] } | null;
}
