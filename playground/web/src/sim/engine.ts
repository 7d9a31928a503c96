// The clock of the simulation. It advances the bus in slices that never take longer
// than a budget, and hands the page one snapshot per drawn picture.

import { CHAIN, type Address, type Bus, type Command, type Report, type Value } from './api';
import { FRAME_BYTES } from './packed';

/** Longest time a slice may compute, in milliseconds. */
const BUDGET = 8;
/** Rest between slices, in milliseconds. */
const REST = 4;
/** Longest wall time that one slice makes up for: a sleeping tab does not catch up. */
const LONGEST_GAP = 100;
/** Frames in one batch; the rest waits in virtual time. */
const MOST_FRAMES = 2000;
/** Virtual microseconds between two looks at the budget. */
const SLICE = 50_000;
/** Pictures that may be under way to the page. */
const MOST_UNDRAWN = 2;
/** Frames at the end of a batch that come with their words. */
const WITH_WORDS = 48;
/** Milliseconds between two readings of the watched objects. */
const WATCH_PERIOD = 200;

export class Engine {
  private running = true;
  private factor = 1;
  private last = performance.now();
  private undrawn = 0;
  private changed = true;
  private watched: Address[] = [];
  private watchedAt = 0;
  private watchedAgain = true;
  private rate = 0;
  private rateFrom = { wall: performance.now(), virtual: 0 };
  private isOpen = false;

  constructor(
    private readonly bus: Bus,
    private readonly report: (report: Report, transfer?: Transferable[]) => void,
  ) {
    this.schedule();
  }

  handle(command: Command): void {
    switch (command.op) {
      case 'open': {
        const { source, nodeId } = command;
        const result =
          source.kind === 'builtin' ? this.bus.openBuiltin(source.name, nodeId) : this.bus.openEds(source.text, nodeId, source.lenient);
        if (result.device) this.isOpen = true;
        this.report({ op: 'opened', source, result });
        break;
      }
      case 'send':
        this.bus.send(command.id, command.data, command.extended, command.remote);
        break;
      case 'run':
        this.running = command.running;
        this.last = performance.now();
        break;
      case 'speed':
        this.factor = command.factor;
        this.rateFrom = { wall: performance.now(), virtual: this.bus.now() };
        break;
      case 'step':
        this.bus.advance(command.micros, MOST_FRAMES);
        break;
      case 'power':
        this.bus.setPower(command.on);
        break;
      case 'turn':
        this.bus.turnTo(command.turns);
        break;
      case 'rpm':
        this.bus.setRpm(command.rpm);
        break;
      case 'watch':
        this.watched = command.addresses;
        this.watchedAgain = true;
        break;
      case 'describe':
        this.report({ op: 'described', ticket: command.ticket, words: this.describe(command.frames) });
        return;
      case 'drawn':
        this.undrawn = Math.max(0, this.undrawn - 1);
        return;
    }
    this.changed = true;
  }

  private schedule(): void {
    setTimeout(() => {
      this.slice();
      this.schedule();
    }, REST);
  }

  private slice(): void {
    const wall = performance.now();
    const gap = Math.min(wall - this.last, LONGEST_GAP);
    this.last = wall;
    if (!this.isOpen) return;
    if (this.running) {
      // What was missed at the end of the budget is missed: time is slower, not late.
      let left = Math.floor(gap * 1000 * this.factor);
      while (left > 0 && this.bus.pending() < MOST_FRAMES && performance.now() - wall < BUDGET) {
        const passed = this.bus.advance(Math.min(left, SLICE), 256);
        if (passed <= 0) break;
        left -= passed;
      }
      this.measure(wall);
      this.changed = true;
    }
    if (this.changed && this.undrawn < MOST_UNDRAWN) this.snapshot(wall);
  }

  private measure(wall: number): void {
    const passed = wall - this.rateFrom.wall;
    if (passed < 400) return;
    const now = this.bus.now();
    this.rate = (now - this.rateFrom.virtual) / 1000 / passed;
    this.rateFrom = { wall, virtual: now };
  }

  private describe(frames: Uint8Array): string[] {
    const words: string[] = [];
    for (let at = 0; at + FRAME_BYTES <= frames.length; at += FRAME_BYTES) {
      words.push(this.bus.describe(frames.subarray(at, at + FRAME_BYTES)));
    }
    return words;
  }

  private snapshot(wall: number): void {
    const { bus } = this;
    const frames = bus.drain();
    const words = this.describe(frames.subarray(Math.max(0, frames.length - WITH_WORDS * FRAME_BYTES)));
    let values: Value[] | null = null;
    if (this.watchedAgain || wall - this.watchedAt > WATCH_PERIOD) {
      values = this.watched.map(({ index, sub }) => bus.read(index, sub));
      this.watchedAt = wall;
      this.watchedAgain = false;
    }
    const shaft = bus.shaft();
    this.changed = false;
    this.undrawn += 1;
    this.report(
      {
        op: 'snapshot',
        snapshot: {
          now: bus.now(),
          running: this.running,
          rate: this.running ? this.rate : 0,
          powered: bus.powered(),
          nmt: bus.nmt(),
          nodeId: bus.nodeId(),
          leds: bus.leds(),
          shaft,
          frames,
          words,
          chain: shaft && CHAIN.map(({ index, sub }) => bus.read(index, sub)),
          values,
        },
      },
      [frames.buffer],
    );
  }
}
