// What page and worker tell each other about a real bus.

import type { Input, Source } from '../wasm/od_playground';

/** Where the bus is: behind a WebSocket, or behind an adapter whose port the page has opened. */
export type Target = { kind: 'ws'; address: string; name: string } | { kind: 'serial'; rate: number | null; name: string };

/** Reason why no connection was made. `said`: the other side gives it in words. */
export type Why = { kind: 'refused' | 'denied' | 'slow' | 'silent' | 'closed' | 'gone' } | { kind: 'said'; text: string };

export type RealCommand =
  /** Answers with `Why`, or null once the bus is open. `devices`: virtual ones that go on it. */
  | { is: 'connect'; ticket: number; to: Target; devices: { source: Source; nodeId: number }[] }
  | { is: 'leave' }
  | { is: 'sending'; on: boolean }
  /** Tries again now. */
  | { is: 'again' }
  /** Puts the description of a node beside the devices. */
  | { is: 'describe'; ticket: number; input: Input }
  /** Which built-in device has this identity. */
  | { is: 'identify'; ticket: number; vendor: number; product: number }
  /** The port of the page: bytes came, it was pulled out, these had no room in it. */
  | { is: 'bytes'; bytes: Uint8Array }
  | { is: 'gone' }
  | { is: 'unsent'; bytes: Uint8Array };

export type RealReport =
  /** The real bus is shown, or the virtual bench again. */
  | { tells: 'begun' | 'left' }
  /** For the port of the page. */
  | { tells: 'bytes'; bytes: Uint8Array };

/** State of a link. */
export interface RealState {
  name: string;
  kind: Target['kind'];
  status: 'open' | 'lost';
  /** Why it was lost. */
  why: Why | null;
  sending: boolean;
  /** Frames that were held back because sending is off. */
  held: number;
  /** Frames that were dropped because the page was slow. */
  dropped: number;
  /** Frames that did not go out because the link was slow. */
  unsent: number;
  /** Frames that the adapter did not send. */
  refused: number;
  /** Lines that were none of slcan. */
  noise: number;
  /** Frames that came. */
  frames: number;
  /** Node IDs that were heard. */
  nodes: number[];
}
