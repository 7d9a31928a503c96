// The nodes of a bus, as far as its frames tell: NMT state, heartbeat, EMCY, device type.

import type { Frame, Ring } from './ring';

/** NMT states by their code in a heartbeat (CiA 301, chapter 7.2.8.3); after its boot-up message a node is Pre-operational. */
const STATES: Record<number, NodeState> = { 0: 'pre-operational', 4: 'stopped', 5: 'operational', 127: 'pre-operational' };
/** NMT states by the command that orders them (CiA 301, chapter 7.2.8.2.1). */
const ORDERS: Record<number, NodeState> = { 1: 'operational', 2: 'stopped', 128: 'pre-operational' };
/** A heartbeat is late after this number of its periods. */
const LATE = 1.5;

export type NodeState = 'unknown' | 'pre-operational' | 'operational' | 'stopped';

/** A node that sent a frame. */
export interface Seen {
  node: number;
  frames: number;
  /** Time of its last frame, in virtual microseconds. */
  at: number;
  state: NodeState;
  /** The state is that of an NMT command: no heartbeat has confirmed it. */
  isOrdered: boolean;
  /** Time of the last heartbeat, and the time between the last two; null: not known. */
  heartbeat: number | null;
  period: number | null;
  /** Number of its last EMCY message, and the error code; 0: no error. */
  emcy: { number: number; code: number; at: number } | null;
  /** Value of 1000h, if a client read it. */
  type: number | null;
}

const word = (data: Uint8Array, at: number): number => data[at]! + 256 * data[at + 1]!;

/** Whether the heartbeat of a node is late at this time. */
export const isLate = (one: Seen, now: number): boolean => one.heartbeat !== null && one.period !== null && now - one.heartbeat > one.period * LATE;

export class Nodes {
  private readonly known = new Map<number, Seen>();
  /** The next frame to read. */
  private next = 0;

  constructor(private readonly ring: Ring) {}

  /** The nodes by node ID. */
  get all(): Seen[] {
    return [...this.known.values()].sort((a, b) => a.node - b.node);
  }

  /** Reads the frames since the last call. */
  follow(): void {
    if (this.next > this.ring.end) this.restart();
    for (this.next = Math.max(this.next, this.ring.first); this.next < this.ring.end; this.next++) this.take(this.ring.get(this.next)!, this.next);
  }

  /** The capture is another one: its frames are read again. */
  restart(): void {
    this.known.clear();
    this.next = this.ring.first;
  }

  private take(frame: Frame, number: number): void {
    if (frame.disturbed || frame.extended) return;
    if (frame.id === 0 && frame.data.length === 2) return this.ordered(frame.data[0]!, frame.data[1]!);
    const node = frame.id & 0x7f;
    // The predefined connection set (CiA 301, chapter 7.3.3): functions in which a node sends.
    const service = frame.id - node;
    if (node === 0 || frame.remote || ![0x080, 0x180, 0x280, 0x380, 0x480, 0x580, 0x700].includes(service)) return;
    const one = this.known.get(node) ?? { node, frames: 0, at: 0, state: 'unknown', isOrdered: false, heartbeat: null, period: null, emcy: null, type: null };
    this.known.set(node, one);
    one.frames += 1;
    one.at = frame.time;
    if (service === 0x700 && frame.data.length === 1) this.told(one, frame);
    else if (service === 0x080 && frame.data.length >= 2) one.emcy = { number, code: word(frame.data, 0), at: frame.time };
    // The response to an upload of 1000h.
    else if (service === 0x580 && frame.data.length === 8 && frame.data[0] === 0x43 && word(frame.data, 1) === 0x1000) one.type = word(frame.data, 4) + 65_536 * word(frame.data, 6);
  }

  private told(one: Seen, { data, time }: Frame): void {
    const code = data[0]! & 0x7f;
    one.state = STATES[code] ?? 'unknown';
    one.isOrdered = false;
    if (code === 0) {
      // A boot-up message is not a heartbeat, and ends the errors of before.
      [one.heartbeat, one.period, one.emcy] = [null, null, null];
      return;
    }
    one.period = one.heartbeat === null ? null : time - one.heartbeat;
    one.heartbeat = time;
  }

  private ordered(command: number, node: number): void {
    const state = ORDERS[command];
    if (!state) return;
    for (const one of this.known.values()) {
      if ((node !== 0 && one.node !== node) || one.state === state) continue;
      one.state = state;
      one.isOrdered = true;
    }
  }
}
