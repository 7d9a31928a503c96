// The messages about a real bus between page and worker.

import type { Input, Source } from '../wasm/od_playground';

/** Location of the bus: behind a WebSocket, or behind an adapter whose port the page has opened. */
export type Target = { kind: 'ws'; address: string; name: string } | { kind: 'serial'; rate: number | null; name: string };

/** Reason why no connection was made. `said`: the text is the message of the other side. */
export type Why = { kind: 'refused' | 'denied' | 'slow' | 'silent' | 'closed' | 'gone' } | { kind: 'said'; text: string };

export type RealCommand =
  /** Returns `Why`, or null when the bus is open. `devices`: virtual devices to put on it. */
  | { is: 'connect'; ticket: number; to: Target; devices: { source: Source; nodeId: number }[] }
  | { is: 'leave' }
  | { is: 'sending'; on: boolean }
  /** Tries again at once. */
  | { is: 'again' }
  /** Adds the description of a node to the devices. */
  | { is: 'describe'; ticket: number; input: Input }
  /** The built-in device with this identity. */
  | { is: 'identify'; ticket: number; vendor: number; product: number }
  /** Events of the page's port: bytes received, unplugged, bytes that were not accepted. */
  | { is: 'bytes'; bytes: Uint8Array }
  | { is: 'gone' }
  | { is: 'unsent'; bytes: Uint8Array };

export type RealReport =
  /** Whether the real bus or the virtual bench is shown. */
  | { tells: 'begun' | 'left' }
  /** Data for the page's port. */
  | { tells: 'bytes'; bytes: Uint8Array };

/** State of a link. */
export interface RealState {
  name: string;
  kind: Target['kind'];
  status: 'open' | 'lost';
  /** Reason why it was lost. */
  why: Why | null;
  sending: boolean;
  /** Frames that were held back because sending is off. */
  held: number;
  /** Frames that were dropped because the page was too slow. */
  dropped: number;
  /** Frames that were not sent because the link was too slow. */
  unsent: number;
  /** Frames that the adapter did not send. */
  refused: number;
  /** Lines that are not valid slcan. */
  noise: number;
  /** Received frames. */
  frames: number;
  /** Node IDs that sent a frame. */
  nodes: number[];
}
