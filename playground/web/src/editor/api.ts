// The types that page and language-server worker exchange.

import type { Difference } from '../wasm/od_playground';
import type { Range } from './protocol';

export type { Difference };

export type Severity = 'error' | 'warning' | 'info';

/** In the order of the list. */
export const SEVERITIES = ['error', 'warning', 'info'] as const satisfies Severity[];

/** A finding as a list shows it. */
export interface Finding {
  range: Range;
  severity: Severity;
  code: string;
  message: string;
  /** Advice; may be empty. */
  help: string;
  /** The line of the finding, if the text is unchanged since it was opened. */
  source: string;
}

/** The findings of a rule. */
export interface Group {
  code: string;
  /** The class of fault, in a few words. */
  title: string;
  severity: Severity;
  count: number;
}

/** The findings of a text: for marks in the text, and for the list of rules. */
export interface Found {
  version: number;
  counts: Record<Severity, number>;
  /** Errors first. */
  groups: Group[];
  /** For each finding line and character of its start and end, and its index in `SEVERITIES`; sorted by place. */
  places: Uint32Array;
}

/** Indices of the findings in `places`. */
export const PLACE = 5;

/** Origin of a text: a built-in device, a text, or the bytes of a file. */
export type Origin = { name: string } | { text: string } | { bytes: Uint8Array };

/** The sections of a text. */
export interface Outline {
  /** One name for each line. */
  names: string;
  lines: Uint32Array;
  /** 1 below an object. */
  depths: Uint8Array;
}

/** Requests of the page; each has an answer. */
export interface Requests {
  /** Opens a text with this URI; returns the URI. */
  open(uri: string, origin: Origin): string;
  /** Findings of a version in a range, in the order of the groups; empty for an older version. */
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
