// The interface between page and simulation: functions of a bus, and the messages
// between page and worker. Only numbers, strings and plain records.

import type { RealCommand, RealReport, RealState } from '../real/api';
import type { Builtin, Bus, caseRow, Chain, dbcWords, decodeEds, DeviceInfo, diagnose, Entry, faultCases, foreignFile, Input, JournalNews, judgeAnswer, judgeCase, Lesson, LessonState, LineStatus, openCase, parseLesson, plainEds, readDbc, readLog, Status, tryProbe, Value, writeLog } from '../wasm/od_playground';

export type { Applied, Builtin, CableState, CaseMark, Chain, DeviceInfo, Diagnostic, Entry, FaultCase, Field, FrameTemplate, Incident, Input, Judgement, Lamp, Lesson, LessonState, LineStatus, Log, Mapped, MappingStep, MasterSlave, MasterState, ObjectRecord, OpenedCase, Outcome, Pdo, Pin, ProbeReading, Source, Status, Transfer, Value } from '../wasm/od_playground';

export interface Address {
  index: number;
  sub: number;
}

/** Questions of the page to the bus; they change nothing. */
export type Questions = Pick<Bus, 'cable' | 'describeAll' | 'fields' | 'mappingSteps' | 'master' | 'pdos' | 'pins' | 'read'>;

/** Functions of the whole module that need no bus. */
export interface Tools {
  caseRow: typeof caseRow;
  dbcWords: typeof dbcWords;
  decodeEds: typeof decodeEds;
  diagnose: typeof diagnose;
  faultCases: typeof faultCases;
  foreignFile: typeof foreignFile;
  judgeAnswer: typeof judgeAnswer;
  judgeCase: typeof judgeCase;
  openCase: typeof openCase;
  parseLesson: typeof parseLesson;
  plainEds: typeof plainEds;
  readDbc: typeof readDbc;
  readLog: typeof readLog;
  tryProbe: typeof tryProbe;
  writeLog: typeof writeLog;
}

/** Requests of the page to the worker. */
export type Command =
  | { op: 'do'; input: Input; ticket?: number }
  /** `quiet`: frames of the first moment are not shown; `waits`: later commands wait until it is done. */
  | { op: 'restore'; entries: Entry[]; until: number; quiet: boolean; waits?: boolean }
  | { op: 'setup'; ticket: number }
  | { op: 'dcf'; ticket: number; node: number }
  | { op: 'run'; running: boolean }
  | { op: 'speed'; factor: number }
  | { op: 'step'; micros: number; frames: number }
  /** Goes back to a moment (later inputs are repeated), or to the moment before a journal entry (later inputs are removed). */
  | { op: 'back'; to: number }
  | { op: 'back'; to: null; entry: number; ticket: number }
  | { op: 'select'; node: number }
  /** `chosen`: the object whose saved value is read, too. */
  | { op: 'watch'; addresses: Address[]; chosen: Address | null }
  | { op: 'plot'; addresses: Address[] }
  | { op: 'look'; eeprom: boolean }
  /** Reads an object over the bus, or writes it if there are bytes. */
  | { op: 'transfer'; ticket: number; node: number; index: number; sub: number; bytes: Uint8Array | null }
  /** Each call has its own arguments. */
  | { op: 'ask'; ticket: number; name: keyof Questions; calls: unknown[][] }
  | { op: 'tool'; ticket: number; name: keyof Tools; args: unknown[] }
  | { op: 'replay'; ticket: number; frames: Uint8Array; speed: number; paused: boolean }
  /** For the log that is sent: another speed, pause or continue, the next frame now, or stop. */
  | { op: 'player'; speed?: number; paused?: boolean; steps?: boolean; ends?: boolean }
  /** About a real bus. */
  | { op: 'real'; what: RealCommand }
  | { op: 'drawn' }
  /** Answered at once, before other work. */
  | { op: 'ping' };

/** Reports of the worker to the page. */
export type Report =
  | { op: 'ready'; builtins: Builtin[]; module: WebAssembly.Module }
  /** Result of the command with this ticket. */
  | { op: 'answer'; ticket: number; value: unknown }
  | { op: 'devices'; devices: DeviceInfo[]; lesson: Lesson | null }
  | { op: 'rewound'; to: number }
  | { op: 'real'; what: RealReport }
  | { op: 'pong' }
  | { op: 'snapshot'; snapshot: Snapshot }
  | { op: 'crashed'; message: string };

/** The state of all devices at one virtual moment. */
export interface Snapshot {
  now: number;
  running: boolean;
  /** A run is being repeated. */
  replaying: boolean;
  /** Frames of a log that are not sent yet. */
  toSend: number;
  /** The link to a real bus; null on the virtual bench. */
  real: RealState | null;
  /** Virtual seconds per second, as measured. */
  rate: number;
  nodes: Status[];
  line: LineStatus;
  /** Progress of the lesson. */
  lesson: LessonState | null;
  /** New frames, packed. */
  frames: Uint8Array;
  /** The texts of the last frames of the batch. */
  words: string[];
  /** Events of EEPROMs: damage, interrupted saves. */
  notices: string[];
  /** The entries of the journal from the first changed one on. */
  journal: JournalNews | null;
  /** For the selected node: the steps from the raw position to the position value; null without a shaft. */
  chain: Chain | null;
  /** For the selected node: values of the watched objects, if they were read again. */
  values: Value[] | null;
  /** For the selected node: the saved value of the chosen object; sent with the values. */
  saved: Value;
  /** For the selected node: objects whose saved value differs, as `index * 256 + sub`; sent with the values. */
  unsaved: Uint32Array | null;
  /** For the selected node: the bytes of its EEPROM, while they are shown. */
  eeprom: Uint8Array | null;
  /** Values of the plotted objects, and their device: the selection may have changed. */
  plot: { node: number; addresses: Address[]; values: Value[] } | null;
}
