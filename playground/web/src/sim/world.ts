// The simulated bench. It starts in the small module, and continues in the whole one if that
// is needed: its journal is repeated there.

import type { Applied, Builtin, Command, Entry, Input, Lesson, LessonState, Outcome, Tools } from './api';
import type { Adapter, Bus as Simulation } from '../wasm/od_playground';

/** One of the two WebAssembly modules; the small one lacks EDS texts and lessons. */
export interface Module extends Partial<Tools> {
  Bus: new (micros?: number) => Simulation;
  builtinDevices(): Builtin[];
  /** The protocol of an adapter; only the whole module has it. */
  Adapter?: new () => Adapter;
  identify?(vendor: number, product: number): string | null;
  /** Whether it can run EDS texts and lessons. */
  whole: boolean;
}

export interface Modules {
  /** The small module, which others can use once it is loaded. */
  compiled(): WebAssembly.Module;
  core(): Promise<Module>;
  whole(): Promise<Module>;
}

/** Maximum time without handling messages of the page, in milliseconds. */
const BUDGET = 50;
/** Virtual microseconds and frames between two checks of the budget. */
const SLICE = 1_000_000;
const MOST_FRAMES = 2000;
/** Number of stops without progress after which a run ends: a checkpoint or a full batch can stop time once. */
const MOST_STUCK = 1000;

const WHOLE: ReadonlySet<Input['op']> = new Set<Input['op']>(['lesson', 'leave', 'script']);
export class World {
  bus: Simulation;
  /** Callers that wait for the end of transfers, by transfer number. */
  private readonly tickets = new Map<number, number>();
  private unseen: Uint8Array = new Uint8Array(0);

  constructor(
    readonly modules: Modules,
    protected module: Module,
  ) {
    this.bus = this.fresh();
  }

  /** An empty bench on a real line. */
  protected fresh(): Simulation {
    const bus = new this.module.Bus();
    bus.restore([], false);
    return bus;
  }

  builtins(): Builtin[] {
    return this.module.builtinDevices();
  }

  private needsWhole(input: Input): boolean {
    if (input.op !== 'add') return WHOLE.has(input.op);
    const { source } = input;
    return source.kind === 'eds' || this.builtins().some((one) => one.whole && source.kind === 'builtin' && one.name === source.name);
  }

  /** Sends an input to the bench. */
  async act(input: Input): Promise<Applied & { entry?: number }> {
    if (this.needsWhole(input)) await this.enlarge();
    const { bus } = this;
    if (input.op === 'add') {
      // The report gets the findings of a file from the language server.
      const entry = input.place == null ? undefined : bus.entries().length - bus.toCome();
      const { node, diagnostics } = bus.act(input);
      return { node, diagnostics: diagnostics.filter(({ code }) => !code), ...(entry !== undefined && { entry }) };
    }
    const added = bus.act(input);
    if (input.op === 'lesson' && added.node !== null) this.unseen = new Uint8Array(0);
    return added;
  }

  /** An empty bench, and a run to repeat. */
  async restore(entries: Entry[], quiet: boolean): Promise<void> {
    if (entries.some(({ input }) => this.needsWhole(input))) await this.enlarge();
    this.bus.restore(entries, quiet);
  }

  /** Reads or writes an object over the bus, for the command with this ticket. */
  transfer({ ticket, node, index, sub, bytes }: Extract<Command, { op: 'transfer' }>): void {
    this.tickets.set(this.bus.transfer(node, index, sub, bytes), ticket);
  }

  /** The completed transfers, each with its ticket. */
  outcomes(): [number, Outcome | null][] {
    return this.bus.outcomes().map((outcome) => {
      const ticket = this.tickets.get(outcome.job) ?? 0;
      this.tickets.delete(outcome.job);
      return [ticket, outcome];
    });
  }

  /** The whole module, for functions without the bench, which stays in the small one. */
  async tools(): Promise<Module> {
    return this.module.whole ? this.module : this.modules.whole();
  }

  /** The result of a function, or the reason why it failed. */
  async use(name: keyof Tools, args: unknown[]): Promise<{ value: unknown } | { error: string }> {
    const tool = (await this.tools())[name] as (...args: unknown[]) => unknown;
    try {
      return { value: tool(...args) };
    } catch (error) {
      return { error: error instanceof Error ? error.message : String(error) };
    }
  }

  /** A DCF of a device with its current configuration. */
  async dcf(node: number): Promise<string | null> {
    await this.enlarge();
    try {
      return this.bus.exportDcf(node);
    } catch {
      return null;
    }
  }

  /** Moves the bench to the whole module. */
  private async enlarge(): Promise<void> {
    if (this.module.whole) return;
    const { bus } = this;
    this.module = await this.modules.whole();
    this.bus = this.fresh();
    await this.again(bus.entries(), bus.now());
    // Frames that the page has not received yet were sent by the earlier bench; they are reported first.
    this.unseen = bus.drain();
    bus.free();
  }

  /** Goes back to a moment; later inputs are repeated when time reaches them. */
  async rewind(to: number): Promise<void> {
    this.unseen = new Uint8Array(0);
    await this.again(this.bus.entries(), to);
  }

  /** Goes back to the moment before a journal entry; later inputs are removed. */
  async takeBack(entry: number): Promise<void> {
    const entries = this.bus.entries();
    const at = entries[entry]?.at;
    this.unseen = new Uint8Array(0);
    if (at !== undefined) await this.again(entries.slice(0, entry), at);
  }

  /** Repeats a run up to a moment without showing it, and stays responsive. */
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
      // Inputs of this moment are part of it.
      if (left <= 0 && !isDone) break;
      stuck = passed > 0 || isDone ? 0 : stuck + 1;
      if (performance.now() - since > BUDGET) {
        await new Promise((resolve) => setTimeout(resolve));
        since = performance.now();
      }
    }
    // Events of the past are not reported again.
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

  /** Returns whether a checkpoint was reached since the last call. */
  reachedGoal(): boolean {
    // Checked before time advances, so that a moved switch can reach a checkpoint.
    return this.lessonState() !== null && this.bus.lessonEvents().length > 0;
  }
}
