//! The TypeScript side of the records.

use wasm_bindgen::prelude::*;

#[cfg(feature = "lessons")]
#[wasm_bindgen(typescript_custom_section)]
const LESSON_TYPES: &str = r#"
/** Something wrong with the text of a lesson. */
export interface LessonProblem {
  /** Counted from 1. */
  line: number;
  column: number;
  message: string;
  /** What to do. */
  help: string;
}

/** A lesson as it was written; texts are Markdown. */
export interface Lesson {
  title: string;
  /** What it is about, in a sentence; may be empty. */
  summary: string;
  /** `en`, `de` … */
  language: string;
  /** 1 for beginners, 2, 3. */
  level: number;
  minutes: number;
  intro: string;
  steps: LessonStep[];
}

export interface LessonStep {
  title: string;
  text: string;
  /** Each tells a bit more than the one before. */
  hints: string[];
  /** What just happened: to be shown once the checkpoint is reached. */
  happened: string;
  quiz: LessonQuiz | null;
  /** Lines for `Bus.runScript`. */
  solution: string;
}

/** Predict a frame, then see it. */
export interface LessonQuiz {
  question: string;
  /** For `judgeAnswer`, and to be shown; `..` and `*` are bytes that do not matter. */
  answer: string;
  reveal: string;
}

export interface LessonResult {
  lesson: Lesson | null;
  problems: LessonProblem[];
}

/** One thing that the present step asks for. */
export interface LessonRequirement {
  holds: boolean;
  /** What it is, and what is missing of it; lost: it held since the step began, and no longer does. */
  text: string; lost?: boolean;
}

export interface LessonState {
  /** The present step, counted from 0; the number of steps when all is done. */
  step: number;
  done: boolean;
  /** Virtual microseconds at which each checkpoint was reached. */
  reached: number[];
  requirements: LessonRequirement[];
}

/** What is right about an answer. */
export interface Judgement {
  right: boolean;
  wrongIdentifier: boolean;
  wrongLength: boolean;
  /** Counted from 0. */
  wrongBytes: number[];
}
"#;

#[wasm_bindgen(typescript_custom_section)]
const TYPES: &str = r#"
/** A value: 64-bit integers that a number cannot hold come as bigint. */
export type Value = number | bigint | string | boolean | Uint8Array | null;

/** One value of the object dictionary. */
export interface ObjectRecord {
  index: number;
  sub: number;
  /** The name of the object, or of the member of a record or array. */
  name: string;
  /** The name of the record or array, for its members. */
  parent: string | null;
  /** `UNSIGNED32`, `VISIBLE_STRING`, as in CiA 301. */
  type: string;
  /** Length in bits; 0 where it varies. */
  bits: number;
  access: 'ro' | 'wo' | 'rw' | 'rwr' | 'rww' | 'const';
  /** May be mapped into a PDO. */
  mappable: boolean;
  /** May be mapped into a TPDO, as far as access and length go. */
  fitsTpdo: boolean;
  /** May be mapped into an RPDO, as far as access and length go. */
  fitsRpdo: boolean;
  /** Belongs to a PDO mapping parameter. */
  isMapping: boolean;
  /** Is among what 1010h saves. */
  isSaved: boolean;
  default: Value;
  low: Value;
  high: Value;
}

/** Something to say about an EDS text. */
export interface Diagnostic {
  /** Stable, such as `E0412`. */
  code: string;
  severity: 'error' | 'warning' | 'info';
  message: string;
  /** How to fix it; empty if the message says so. */
  help: string;
  /** Counted from 1; 0 where something is missing altogether. */
  line: number;
  column: number;
  /** The object it is about, such as `6004h`, or empty. */
  object: string;
  /** The automatic fix, if there is one. */
  fix: Fix | null;
}

/** Edits of the text that was checked; all of them together, or none. */
export interface Fix {
  /** A safe fix: the meaning of the text does not change. */
  safe: boolean;
  edits: TextEdit[];
}

/** `text` replaces what is from `start` to before `end`, as in `String.slice`. */
export interface TextEdit {
  start: number;
  end: number;
  text: string;
}

export interface EdsResult {
  device: number | null;
  diagnostics: Diagnostic[];
}

export type Nmt = 'off' | 'unknown' | 'initialising' | 'pre-operational' | 'operational' | 'stopped';

export type Lamp = 'off' | 'on' | 'flashing';

export interface Leds {
  green: Lamp;
  red: Lamp;
}

export interface Shaft {
  /** Revolutions from the sensor's zero point, with the fraction. */
  turns: number;
  rpm: number;
  /** What the sensor delivers, before scaling. */
  raw: number;
}

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
  controller: 'error active' | 'error passive' | 'bus-off';
  /** Hangs on the line. */
  plugged: boolean;
  /** The shaft follows a profile. */ moves: boolean;
  /** Describes a node of a real bus. */ real: boolean;
}

/** The wire, and the controller of the outside. */
export interface LineStatus {
  real: boolean;
  /** Frames take the time of their bits; `busy`: microseconds that they took so far. */
  timed: boolean;
  busy: number;
  terminators: number;
  fixedRate: number | null;
  rate: number | null;
  transmitErrors: number;
  receiveErrors: number;
  controller: 'error active' | 'error passive' | 'bus-off';
  plugged: boolean;
}

/** A part of a frame. */
export interface Field {
  /** The first byte, and the one after the last. */
  from: number;
  to: number;
  name: string;
  value: string;
  /** The object that it is about, as `index * 256 + sub`. */
  object: number | null;
}

/** A transfer of `Bus.transfer` that is over. */
export interface Outcome {
  job: number;
  kind: 'done' | 'aborted' | 'silent' | 'failed';
  /** The value that was read; empty after a write, null where there is none. */
  bytes: Uint8Array | null;
  /** Why it failed; empty if nobody answered. */
  words: string;
  /** The abort may come from a mapping that changes while its PDO is valid. */
  wantsPdoOff: boolean;
}

export interface Mapped {
  index: number;
  sub: number;
  bits: number;
}

/** A PDO as it is now. */
export interface Pdo {
  /** Index of its mapping parameter. */
  mapping: number;
  /** Index of its communication parameter. */
  parameter: number;
  transmits: boolean;
  /** Counted from 1. */
  number: number;
  /** Value of its COB-ID object, and what it says; null without power. */
  cobId: { raw: number; id: number; valid: boolean } | null;
  /** Mapping entries that fit. */
  room: number;
  /** The mapping cannot be written. */
  isFixed: boolean;
  entries: Mapped[];
}

/** An SDO download, and its frame. */
export interface MappingStep {
  part: 'disable PDO' | 'disable mapping' | 'entry' | 'enable mapping' | 'enable PDO';
  index: number;
  sub: number;
  bytes: Uint8Array;
  id: number;
  data: Uint8Array;
  words: string;
}

/** From the raw position to the position value; null where it cannot be read. */
export interface Chain {
  reversed: boolean | null;
  /** Measuring units per revolution; null without scaling. */
  perTurn: number | null;
  position: number | null;
}

export interface FrameTemplate {
  name: string;
  /** Packed. */
  frame: Uint8Array;
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

export type Source = { kind: 'builtin'; name: string } | { kind: 'eds'; name: string; text: string; lenient: boolean };

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

/** What came of an input that puts a device on the bus, begins a lesson, or plays a script. */
export interface Added {
  /** Its number, or null where it cannot run. */
  node: number | null;
  diagnostics: Diagnostic[];
}

/** Entries that are new, and how many are before them. */
export interface JournalNews {
  from: number;
  entries: Entry[];
}

/** A frame that was typed, or what is wrong with it and where. Data of a remote frame: its length. */
export type LineResult =
  | { id: number; extended: boolean; remote: boolean; data: Uint8Array; error?: undefined }
  | { error: string; at: number };

/** A segmented or block transfer. */
export interface Transfer {
  /** Numbers of its frames. */
  frames: number[];
  node: number;
  index: number;
  sub: number;
  isWrite: boolean;
  /** What was transferred so far. */
  bytes: Uint8Array;
  state: 'under way' | 'done' | 'aborted';
}

/** A log that was read. */
export interface Log {
  /** Packed. */
  frames: Uint8Array;
  count: number;
  /** Lines that could not be read; the first of them, and why. */
  skipped: number;
  line: number;
  why: string;
}

export interface Builtin {
  name: string;
  title: string;
}
"#;

#[cfg(test)]
mod tests {
    use od_bench::journal::Input;

    /// `Input` is declared as the journal reads it.
    #[test]
    fn inputs_are_declared_as_they_are_read() -> Result<(), String> {
        let (_, rest) = include_str!("types.rs")
            .split_once("export type Input =")
            .ok_or("Input is declared")?;
        let (declared, _) = rest.split_once("};\n").ok_or("it has an end")?;
        let declared: Vec<_> = format!("{declared}}}")
            .lines()
            .filter_map(|line| Some(line.trim().strip_prefix("| ")?.to_owned()))
            .collect();
        let read: Vec<_> = Input::OPS
            .iter()
            .filter_map(|op| Input::declaration(op))
            .collect();
        assert_eq!(declared, read);
        Ok(())
    }
}
