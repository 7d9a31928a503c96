// The clock of the simulation. It advances the bench in slices with a time budget,
// and sends the page at most one snapshot for each refresh. While time is paused, it does nothing.

import type { Address, Command, Input, Report, Value } from './api';
import { FRAME_BYTES } from './packed';
import { Replay } from './replay';
import type { RealState } from '../real/api';
import type { World } from './world';

/** Maximum computing time of a slice, in milliseconds. */
const BUDGET = 8;
/** Pause between slices that take long, and of a real bus, in milliseconds. */
const REST = 4;
/** Pause between slices otherwise. While something moves, each refresh of the page asks for a slice before. */
const CALM = 20;
/** Maximum wall time that one slice makes up for: a tab that was asleep does not catch up. */
const LONGEST_GAP = 100;
/** Maximum number of frames in a batch; the others wait in virtual time. */
const MOST_FRAMES = 2000;
/** Virtual microseconds between two checks of the budget. */
const SLICE = 50_000;
/** Maximum number of snapshots that the page has not confirmed. */
const MOST_UNDRAWN = 2;
/** Number of frames at the end of a batch that have their texts. */
const WITH_WORDS = 48;
/** Milliseconds between two snapshots of an idle bench. */
const QUIET = 100;
/** Milliseconds between two readings of the watched objects. */
const WATCH_PERIOD = 200;
/** Inputs that change the devices on the bus. */
const TELLING: ReadonlySet<Input['op']> = new Set<Input['op']>(['add', 'remove', 'lesson', 'leave']);
/** Functions that only a simulation has. */
const NOT_REAL: ReadonlySet<Command['op']> = new Set<Command['op']>(['run', 'speed', 'step', 'back', 'replay']);
/** Maximum step in search of a frame, in microseconds. */
const FARTHEST = 60_000_000;

/** A bench whose time is that of a real bus. */
interface Live extends World {
  /** Advances to the present. */
  follow(): void;
  link(): RealState;
}

export class Engine {
  private running = true;
  private factor = 1;
  private last = performance.now();
  private undrawn = 0;
  private changed = true;
  /** The last snapshot: its time, the shaft positions, and whether a shaft turned. */
  private shownAt = 0;
  private turns = '';
  private isTurning = false;
  private selected = 0;
  private watched: Address[] = [];
  private plotted: Address[] = [];
  private chosen: Address | null = null;
  private watchedAt = 0;
  private watchedAgain = true;
  private looksAtEeprom = false;
  private rate = 0;
  private rateFrom = { wall: performance.now(), virtual: 0 };
  /** A repeated run goes at full speed to this moment. */
  private until: number | null = null;
  /** The next slice, and when it is due. */
  private timer = 0;
  private due = Infinity;
  private isBusy = false;
  private replay: Replay | null = null;
  /** The real bus that is shown instead of the virtual bench. */
  private live: Live | null = null;
  private home: World;
  /** Ends the link to the real bus. */
  leave: (() => void) | null = null;

  constructor(
    private world: World,
    readonly report: (report: Report, transfer?: Transferable[]) => void,
  ) {
    this.home = world;
    this.wake(REST);
  }

  /** Shows a real bus, or returns to the virtual bench, which was paused during that time. */
  show(live: Live | null): void {
    this.live = live;
    this.world = live ?? this.home;
    this.replay = null;
    this.selected = 0;
    this.last = performance.now();
    this.report({ op: 'real', what: { tells: live ? 'begun' : 'left' } });
    this.tellDevices();
    this.changed = true;
    this.wake(REST);
  }

  get isLive(): boolean {
    return this.live !== null;
  }

  get virtual(): World {
    return this.home;
  }

  async handle(command: Command): Promise<void> {
    if (this.live) {
      if (NOT_REAL.has(command.op)) return 'ticket' in command ? this.answer(command.ticket ?? 0, null) : undefined;
      // Another bench is always virtual.
      if (command.op === 'restore') this.leave?.();
    }
    const { world } = this;
    switch (command.op) {
      case 'do': {
        this.until = null;
        this.isBusy = true;
        const added = await world.act(command.input);
        this.isBusy = false;
        if (command.input.op === 'send' && !this.running) this.sendOut();
        if (TELLING.has(command.input.op)) this.tellDevices();
        if (command.input.op === 'lesson') this.replay = null;
        this.pauseAtGoal();
        if (command.ticket !== undefined) this.answer(command.ticket, added);
        break;
      }
      case 'restore':
        this.replay = null;
        this.isBusy = true;
        await world.restore(command.entries, command.quiet);
        this.isBusy = false;
        this.until = command.until;
        this.tellDevices();
        // The slices continue.
        this.wake(REST);
        while (command.waits && this.until !== null) await new Promise((resolve) => setTimeout(resolve, REST));
        break;
      case 'run':
        this.running = command.running;
        this.last = performance.now();
        break;
      case 'speed':
        this.factor = command.factor;
        this.rateFrom = { wall: performance.now(), virtual: world.bus.now() };
        break;
      case 'step':
        world.bus.advance(command.frames ? FARTHEST : command.micros, command.frames || MOST_FRAMES);
        this.pauseAtGoal();
        break;
      case 'back':
        this.until = null;
        this.isBusy = true;
        if (command.to === null) await world.takeBack(command.entry);
        else await world.rewind(command.to);
        this.isBusy = false;
        world.reachedGoal();
        this.tellDevices();
        this.report({ op: 'rewound', to: world.bus.now() });
        if (command.to === null) this.answer(command.ticket, null);
        break;
      case 'select':
        this.selected = command.node;
        this.watchedAgain = true;
        break;
      case 'watch':
        this.watched = command.addresses;
        this.chosen = command.chosen;
        this.watchedAgain = true;
        break;
      case 'plot':
        this.plotted = command.addresses;
        break;
      case 'look':
        this.looksAtEeprom = command.eeprom;
        this.watchedAgain = true;
        break;
      case 'transfer':
        this.until = null;
        world.transfer(command);
        break;
      case 'ask': {
        // The small module does not have all functions.
        const ask = world.bus[command.name] as ((...args: unknown[]) => unknown) | undefined;
        this.answer(command.ticket, command.calls.map((args) => ask?.apply(world.bus, args)));
        return;
      }
      case 'tool':
        this.answer(command.ticket, await world.use(command.name, command.args));
        return;
      case 'replay':
        this.replay = new Replay(command.frames, world.bus.now(), command.speed);
        this.replay.set(world.bus.now(), command);
        this.answer(command.ticket, true);
        break;
      case 'player':
        this.replay?.set(world.bus.now(), command);
        if (command.ends) this.replay = null;
        if (command.steps && this.replay) {
          this.sendNext(this.replay);
          if (!this.running) this.sendOut();
        }
        break;
      case 'setup':
        this.answer(command.ticket, this.home.bus.setup());
        return;
      case 'dcf':
        this.isBusy = true;
        this.answer(command.ticket, await world.dcf(command.node));
        this.isBusy = false;
        break;
      case 'ping':
        return;
      case 'drawn':
        this.undrawn = Math.max(0, this.undrawn - 1);
        if (this.hasNews()) this.wake(0);
        return;
    }
    this.changed = true;
    this.wake(REST);
  }

  answer(ticket: number, value: unknown): void {
    this.report({ op: 'answer', ticket, value });
  }

  tellDevices(): void {
    this.report({ op: 'devices', devices: this.world.bus.devices(), lesson: this.world.lesson() });
    this.watchedAgain = true;
  }

  /** Plans a slice after this pause, unless an earlier one is planned. */
  private wake(pause: number): void {
    const due = performance.now() + pause;
    if (due >= this.due) return;
    clearTimeout(this.timer);
    this.due = due;
    this.timer = setTimeout(() => {
      this.due = Infinity;
      this.wake(this.isBusy ? REST : this.slice());
    }, pause);
  }

  /** Returns the pause before the next slice; infinite while time is paused. */
  private slice(): number {
    const { world } = this;
    const wall = performance.now();
    const gap = Math.min(wall - this.last, LONGEST_GAP);
    this.last = wall;
    if (this.live) {
      this.live.follow();
      if (this.isDue(wall)) this.snapshot(wall);
      return REST;
    }
    if (world.bus.deviceCount() === 0 && world.bus.toCome() === 0) {
      if (this.undrawn < MOST_UNDRAWN && this.changed) this.snapshot(wall);
      return this.running ? CALM : Infinity;
    }
    let isSlow = false;
    if (this.until !== null) {
      this.pass(wall, this.until - world.bus.now());
      if (world.bus.now() >= this.until) {
        this.until = null;
        // Inputs of this moment are part of it.
        world.bus.advance(0, MOST_FRAMES);
        // Checkpoints of a repeated run were reported before.
        world.reachedGoal();
        this.tellDevices();
      }
      this.changed = true;
      isSlow = true;
    } else if (this.running) {
      this.pass(wall, Math.floor(gap * 1000 * this.factor));
      isSlow = performance.now() - wall > BUDGET / 4;
    }
    if (this.running) this.measure(wall);
    if (this.isDue(wall)) this.snapshot(wall);
    if (isSlow) return REST;
    return this.running ? CALM : Infinity;
  }

  /** Returns whether there is something to show. While only time passes, an occasional snapshot is enough. */
  private isDue(wall: number): boolean {
    return this.undrawn < MOST_UNDRAWN && (this.hasNews() || (this.isRunning && wall - this.shownAt >= QUIET));
  }

  private get isRunning(): boolean {
    return this.running || this.live !== null;
  }

  /** Returns whether more than the clock has changed since the last snapshot. */
  private hasNews(): boolean {
    return this.changed || (this.isRunning && (this.isTurning || this.world.bus.pending() > 0));
  }

  /** Time beyond the budget is skipped: virtual time is slower, not late. */
  private pass(wall: number, micros: number): void {
    const { world } = this;
    let left = micros;
    const known = world.bus.deviceCount();
    while (left > 0 && world.bus.pending() < MOST_FRAMES && performance.now() - wall < BUDGET) {
      const before = world.bus.toCome();
      const due = this.replay?.due ?? Infinity;
      const passed = world.bus.advance(Math.max(0, Math.min(left, SLICE, due - world.bus.now())), 256);
      left -= passed;
      if (this.until === null && this.pauseAtGoal()) break;
      if (this.replay && world.bus.now() >= due) this.sendNext(this.replay);
      else if (passed <= 0 && world.bus.toCome() === before) break;
    }
    if (world.bus.deviceCount() !== known) this.tellDevices();
  }

  /** A reached checkpoint pauses time: the learner reads. */
  private pauseAtGoal(): boolean {
    const isReached = this.world.reachedGoal() && !this.live;
    if (isReached) {
      this.running = false;
      this.changed = true;
    }
    return isReached;
  }

  /** Paused time continues until a frame of the user is transmitted; the response comes with the next step. */
  private sendOut(): void {
    const { bus } = this.world;
    for (let left = MOST_FRAMES; left > 0 && bus.isSending(); left--) bus.advance(SLICE, 1);
  }

  /** Sends the next frame of a log; the bench responds as usual. */
  private sendNext(replay: Replay): void {
    const input = replay.take(this.world.bus.now());
    if (input) void this.world.act(input);
    if (replay.left === 0) this.replay = null;
  }

  private measure(wall: number): void {
    const passed = wall - this.rateFrom.wall;
    if (passed < 400) return;
    const now = this.world.bus.now();
    this.rate = Math.max(0, (now - this.rateFrom.virtual) / 1000 / passed);
    this.rateFrom = { wall, virtual: now };
  }

  private snapshot(wall: number): void {
    const { world, selected } = this;
    const { bus } = world;
    const frames = world.drain();
    const words = bus.describeAll(frames.subarray(Math.max(0, frames.length - WITH_WORDS * FRAME_BYTES)));
    const read = ({ index, sub }: Address): Value => bus.read(selected, index, sub);
    let values: Value[] | null = null;
    let saved: Value = null;
    let unsaved: Uint32Array | null = null;
    let eeprom: Uint8Array | null = null;
    if (this.watchedAgain || wall - this.watchedAt > WATCH_PERIOD) {
      values = this.watched.map(read);
      unsaved = bus.unsaved(selected, false);
      if (this.chosen) saved = bus.savedValue(selected, this.chosen.index, this.chosen.sub);
      if (this.looksAtEeprom) eeprom = bus.eeprom(selected);
      this.watchedAt = wall;
      this.watchedAgain = false;
    }
    const nodes = Array.from({ length: bus.deviceCount() }, (_, number) => bus.status(number));
    for (const [ticket, outcome] of world.outcomes()) this.answer(ticket, outcome);
    const turns = nodes.map(({ shaft }) => shaft?.turns).join();
    this.isTurning = turns !== this.turns;
    this.turns = turns;
    this.shownAt = wall;
    this.changed = false;
    this.undrawn += 1;
    this.report(
      {
        op: 'snapshot',
        snapshot: {
          now: bus.now(),
          running: this.isRunning,
          replaying: this.until !== null,
          toSend: this.replay?.left ?? 0,
          real: this.live?.link() ?? null,
          rate: this.running ? this.rate : 0,
          nodes,
          line: bus.line(),
          lesson: world.lessonState(),
          frames,
          words,
          notices: bus.notices(),
          journal: bus.news(),
          chain: bus.chain(selected),
          values,
          saved,
          unsaved,
          eeprom,
          plot: this.plotted.length ? { node: selected, addresses: this.plotted, values: this.plotted.map(read) } : null,
        },
      },
      [frames.buffer],
    );
  }
}
