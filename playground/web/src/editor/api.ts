// What crosses between the page and the worker with the language server.

import type { Difference } from '../wasm/od_playground';
import type { Range } from './protocol';

export type { Difference };

export type Severity = 'error' | 'warning' | 'info';

/** In the order in which they are listed. */
export const SEVERITIES = ['error', 'warning', 'info'] as const satisfies Severity[];

/** A finding as a list shows it. */
export interface Finding {
  range: Range;
  severity: Severity;
  code: string;
  message: string;
  /** What to do; may be empty. */
  help: string;
  /** The line that it is about, where the text is as it was opened. */
  source: string;
}

/** The findings of a rule. */
export interface Group {
  code: string;
  /** The class of fault in a few words. */
  title: string;
  severity: Severity;
  count: number;
}

/** What is found in a text: enough to mark it and to list the rules. */
export interface Found {
  version: number;
  counts: Record<Severity, number>;
  /** Errors first. */
  groups: Group[];
  /** Of each finding line and character of its start and its end, and its rank among `SEVERITIES`; by place. */
  places: Uint32Array;
}

/** Numbers of a finding in `places`. */
export const PLACE = 5;

/** What a text comes from: a device of ours, a text, the bytes of a file. */
export type Origin = { name: string } | { text: string } | { bytes: Uint8Array };

/** The sections of a text. */
export interface Outline {
  /** One name a line. */
  names: string;
  lines: Uint32Array;
  /** 1 below an object. */
  depths: Uint8Array;
}

/** What the page asks; each has an answer. */
export interface Requests {
  /** Opens a text under this URI; answers with it. */
  open(uri: string, origin: Origin): string;
  /** Findings of a version from one to before another, in the order of the groups; none of an older version. */
  rows(uri: string, version: number, from: number, to: number): Finding[];
  /** A request of the protocol. */
  request(method: string, params: object): unknown;
  outline(uri: string): Outline;
  compare(before: string, after: string): Difference[];
  /** The bytes of a file with another text. */
  encode(origin: Origin, text: string): Uint8Array;
}

export type Command =
  | { [K in keyof Requests]: { ticket: number; op: K; args: Parameters<Requests[K]> } }[keyof Requests]
  /** Changes as `textDocument/didChange` has them. */
  | { op: 'change'; uri: string; version: number; changes: { range: Range; text: string }[] }
  | { op: 'close'; uri: string };

export type Report =
  | { op: 'answer'; ticket: number; value: unknown }
  | { op: 'refused'; ticket: number; why: string }
  | { op: 'found'; uri: string; found: Found };
