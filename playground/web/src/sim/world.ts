// The simulated bench. It begins in the small module, and goes on in the whole one when something
// needs that: its journal makes it again.

import type { Added, Builtin, Command, Entry, Input, Lesson, LessonState, Outcome, Tools } from './api';
import type { Adapter, Bus as Simulation } from '../wasm/od_playground';

/** One of the two WebAssembly modules; the small one knows no EDS texts and no lessons. */
export interface Module extends Partial<Tools> {
  Bus: new (micros?: number) => Simulation;
  builtinDevices(): Builtin[];
  /** The conversation with an adapter; in the whole module. */
  Adapter?: new () => Adapter;
  identify?(vendor: number, product: number): string | null;
  /** Can it run an EDS text, and a lesson? */
  whole: boolean;
}

export interface Modules {
  /** The small module, for others to use once it is there. */
  compiled(): WebAssembly.Module;
  core(): Promise<Module>;
  whole(): Promise<Module>;
}

/** Longest time without an ear for the page, in milliseconds. */
const BUDGET = 50;
/** Virtual microseconds and frames between two looks at the budget. */
const SLICE = 1_000_000;
const MOST_FRAMES = 2000;
/** A checkpoint or a full batch can stop time once; a run that is stopped again and again ends. */
const MOST_STUCK = 1000;

const WHOLE: ReadonlySet<Input['op']> = new Set<Input['op']>(['lesson', 'leave', 'script']);
const needsWhole = (input: Input): boolean => WHOLE.has(input.op) || (input.op === 'add' && input.source.kind === 'eds');

export class World {
  bus: Simulation;
  /** Who waits for the ends of transfers, by their numbers. */
  private readonly tickets = new Map<number, number>();
  private unseen: Uint8Array = new Uint8Array(0);

  constructor(
    readonly modules: Modules,
    protected module: Module,
  ) {
    this.bus = this.fresh();
  }

  /** An empty bench on a real wire. */
  protected fresh(): Simulation {
    const bus = new this.module.Bus();
    bus.restore([], false);
    return bus;
  }

  builtins(): Builtin[] {
    return this.module.builtinDevices();
  }

  /** Something happens now. */
  async act(input: Input): Promise<Added & { entry?: number }> {
    if (needsWhole(input)) await this.enlarge();
    const { bus } = this;
    if (input.op === 'add') {
      // The findings of a file are for the report, which asks the language server.
      const entry = input.place == null ? undefined : bus.entries().length - bus.toCome();
      const { node, diagnostics } = bus.act(input);
      return { node, diagnostics: diagnostics.filter(({ code }) => !code), ...(entry !== undefined && { entry }) };
    }
    const added = bus.act(input);
    if (input.op === 'lesson' && added.node !== null) this.unseen = new Uint8Array(0);
    return added;
  }

  /** A bench without anything, and a run that is to be made again. */
  async restore(entries: Entry[], quiet: boolean): Promise<void> {
    if (entries.some(({ input }) => needsWhole(input))) await this.enlarge();
    this.bus.restore(entries, quiet);
  }

  /** Reads or writes an object over the bus, for the one with this ticket. */
  transfer({ ticket, node, index, sub, bytes }: Extract<Command, { op: 'transfer' }>): void {
    this.tickets.set(this.bus.transfer(node, index, sub, bytes), ticket);
  }

  /** The transfers that are over, each with its ticket. */
  outcomes(): [number, Outcome | null][] {
    return this.bus.outcomes().map((outcome) => {
      const ticket = this.tickets.get(outcome.job) ?? 0;
      this.tickets.delete(outcome.job);
      return [ticket, outcome];
    });
  }

  /** The whole module, for what has nothing to do with the bench: that stays in the small one. */
  async tools(): Promise<Module> {
    return this.module.whole ? this.module : this.modules.whole();
  }

  /** What a tool says, or why it cannot. */
  async use(name: keyof Tools, args: unknown[]): Promise<{ value: unknown } | { error: string }> {
    const tool = (await this.tools())[name] as (...args: unknown[]) => unknown;
    try {
      return { value: tool(...args) };
    } catch (error) {
      return { error: error instanceof Error ? error.message : String(error) };
    }
  }

  /** A DCF of a device as it is set up. */
  async dcf(node: number): Promise<string | null> {
    await this.enlarge();
    try {
      return this.bus.exportDcf(node);
    } catch {
      return null;
    }
  }

  /** The bench goes on in the whole module. */
  private async enlarge(): Promise<void> {
    if (this.module.whole) return;
    const { bus } = this;
    this.module = await this.modules.whole();
    this.bus = this.fresh();
    await this.again(bus.entries(), bus.now());
    // What the page has not seen yet was sent by the bench before; it is reported first.
    this.unseen = bus.drain();
    bus.free();
  }

  /** Goes back to a moment; what came after comes again. */
  async rewind(to: number): Promise<void> {
    this.unseen = new Uint8Array(0);
    await this.again(this.bus.entries(), to);
  }

  /** Goes back to the moment before an entry of the journal; what came after is forgotten. */
  async takeBack(entry: number): Promise<void> {
    const entries = this.bus.entries();
    const at = entries[entry]?.at;
    this.unseen = new Uint8Array(0);
    if (at !== undefined) await this.again(entries.slice(0, entry), at);
  }

  /** Repeats a run up to a moment, unseen, and stays responsive during that. */
  private async again(entries: Entry[], to: number): Promise<void> {
    const { bus } = this;
    bus.restore(entries, false);
    let since = performance.now();
    let stuck = 0;
    while (stuck < MOST_STUCK) {
      const left = to - bus.now();
      const before = bus.toCome();
      const passed = bus.advance(Math.max(0, Math.min(left, SLICE)), MOST_FRAMES);
      bus.drain();
      const isDone = bus.toCome() !== before;
      // Inputs of that very moment are part of it.
      if (left <= 0 && !isDone) break;
      stuck = passed > 0 || isDone ? 0 : stuck + 1;
      if (performance.now() - since > BUDGET) {
        await new Promise((resolve) => setTimeout(resolve));
        since = performance.now();
      }
    }
    // The past is not news.
    bus.notices();
  }

  /** All frames since the last call. */
  drain(): Uint8Array {
    const fresh = this.bus.drain();
    if (this.unseen.length === 0) return fresh;
    const all = new Uint8Array(this.unseen.length + fresh.length);
    all.set(this.unseen);
    all.set(fresh, this.unseen.length);
    this.unseen = new Uint8Array(0);
    return all;
  }

  lesson(): Lesson | null {
    return this.module.whole ? this.bus.takenLesson() : null;
  }

  lessonState(): LessonState | null {
    return this.module.whole ? this.bus.lesson() : null;
  }

  /** Was a checkpoint reached since the last call? */
  reachedGoal(): boolean {
    // Looking comes first: a switch that was moved counts, too.
    return this.lessonState() !== null && this.bus.lessonEvents().length > 0;
  }
}
