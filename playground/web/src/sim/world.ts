// The simulated bench and its journal. What happened is told by the journal alone, so the
// bench can be made again up to any moment: for a step back, from a link, after a reload.

import type { Added, Builtin, Command, DeviceInfo, Diagnostic, Entry, Input, Lesson, LessonState, Outcome, Source, Tools } from './api';
import type { Bus as Simulation, LessonResult } from '../wasm/od_playground';
import { unpack } from './packed';

/** One of the two WebAssembly modules; the small one knows no EDS texts and no lessons. */
export interface Module extends Partial<Tools> {
  Bus: new (micros?: number) => Simulation;
  builtinDevices(): Builtin[];
  /** Can it run an EDS text, and a lesson? */
  whole: boolean;
  parseLesson?(text: string): LessonResult;
}

export interface Modules {
  /** The small module, for others to use once it is there. */
  compiled(): WebAssembly.Module;
  core(): Promise<Module>;
  whole(): Promise<Module>;
}

/** Frames in one replayed portion: they are thrown away in between. */
const PORTION = 5000;

const WHOLE: ReadonlySet<Input['op']> = new Set<Input['op']>(['lesson', 'leave', 'script']);
const needsWhole = (input: Input): boolean => WHOLE.has(input.op) || (input.op === 'add' && input.source.kind === 'eds');

const fault = (error: unknown): Diagnostic => ({
  code: '', severity: 'error', message: error instanceof Error ? error.message : String(error), help: '', line: 0, column: 0, object: '', fix: null,
});

export class World {
  bus: Simulation;
  devices: { source: Source; nodeId: number; name: string }[] = [];
  /** The lesson that is taken. */
  lesson: Lesson | null = null;
  journal: Entry[] = [];
  /** Entries that have taken effect; those behind are still to come. */
  done = 0;
  /** The first entry that the page does not know. */
  told = 0;

  constructor(
    private readonly modules: Modules,
    private module: Module,
  ) {
    this.bus = this.fresh();
  }

  /** An empty bench on a real wire. */
  private fresh(): Simulation {
    const bus = new this.module.Bus();
    bus.setLine(true, 2, undefined);
    return bus;
  }

  builtins(): Builtin[] {
    return this.module.builtinDevices();
  }

  /** Something happens now. What was still to come of a run before does not happen any more. */
  async act(input: Input): Promise<Added> {
    if (needsWhole(input)) await this.enlarge();
    if (input.op === 'lesson') return this.begins(input);
    if (this.done < this.journal.length) {
      this.journal.length = this.done;
      this.told = Math.min(this.told, this.done);
    }
    // Time passes in a script.
    const at = this.bus.now();
    const added = this.apply(input);
    if (input.op !== 'add' || added.node !== null) {
      this.journal.push({ at, input });
      this.done += 1;
    }
    return added;
  }

  /** Lets time pass, and what the journal has for it; answers with what passed. */
  advance(micros: number, frames: number): number {
    const start = this.bus.now();
    const end = start + micros;
    const full = this.bus.pending() + frames;
    for (;;) {
      const next = this.journal[this.done];
      const until = next && next.at <= end ? next.at : end;
      if (until > this.bus.now()) this.bus.advance(until - this.bus.now(), full - this.bus.pending());
      if (this.request()) continue;
      if (!next || this.bus.now() < next.at || this.bus.pending() >= full) break;
      this.apply(next.input);
      this.done += 1;
    }
    return this.bus.now() - start;
  }

  /** Reads or writes an object over the bus, for the one with this ticket. */
  transfer({ ticket, node, index, sub, bytes }: Extract<Command, { op: 'transfer' }>): void {
    this.tickets.set(this.bus.transfer(node, index, sub, bytes), ticket);
    this.request();
  }

  /** Sends what the SDO client wants to send, as an input like any other. */
  private request(): boolean {
    let any = false;
    for (let packed = this.bus.request(); packed; packed = this.bus.request()) {
      const { id, data, extended, remote } = unpack(packed, 0);
      void this.act({ op: 'send', id, data, extended, remote });
      any = true;
    }
    return any;
  }

  /** The transfers that are over. */
  outcomes(): { ticket: number; outcome: Outcome | null }[] {
    const all = this.given;
    this.given = [];
    for (const outcome of this.bus.outcomes()) all.push({ ticket: this.tickets.get(outcome.job)!, outcome });
    for (const { outcome } of all) if (outcome) this.tickets.delete(outcome.job);
    return all;
  }

  private readonly tickets = new Map<number, number>();
  private given: { ticket: number; outcome: Outcome | null }[] = [];

  /** Another bus: nobody answers any more what was asked on this one. */
  private giveUp(): void {
    for (const ticket of this.tickets.values()) this.given.push({ ticket, outcome: null });
    this.tickets.clear();
  }

  /** The bench as it was at `to`; what came after stays in the journal and comes again. */
  rewind(to: number): void {
    this.begin();
    this.catchUp(to);
  }

  private begin(): void {
    const fresh = this.fresh();
    this.giveUp();
    this.bus.free();
    this.bus = fresh;
    this.devices = [];
    this.lesson = null;
    this.done = 0;
  }

  /** Goes on to `to`, and throws the frames away. */
  private catchUp(to: number): void {
    while (this.bus.now() < to || this.journal[this.done]?.at === to) {
      const before = this.done;
      const passed = this.advance(to - this.bus.now(), PORTION);
      this.bus.drain();
      if (passed <= 0 && this.done === before) break;
    }
  }

  /** A bench without anything, and a run that is to be made again. */
  async restore(entries: Entry[], quiet: boolean): Promise<void> {
    if (entries.some(({ input }) => needsWhole(input)) && !this.module.whole) this.module = await this.modules.whole();
    this.journal = entries;
    this.told = 0;
    this.begin();
    if (quiet) this.catchUp(0);
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
      return { error: fault(error).message };
    }
  }

  /** A DCF of a device as it is set up. */
  async dcf(node: number): Promise<string | null> {
    const source = this.devices[node]?.source;
    if (!source) return null;
    await this.enlarge();
    try {
      return this.bus.exportDcf(node, source.name, source.kind === 'eds' ? source.text : undefined);
    } catch {
      return null;
    }
  }

  private async enlarge(): Promise<void> {
    if (this.module.whole) return;
    const pending = this.bus.drain();
    this.module = await this.modules.whole();
    this.rewind(this.bus.now());
    // What the page has not seen yet was sent by the bench before; it is told first.
    this.unseen = pending;
  }

  private unseen: Uint8Array = new Uint8Array(0);

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

  infos(): DeviceInfo[] {
    return this.devices.map(({ source, nodeId, name }, number) => ({
      name,
      title: this.bus.title(number),
      nodeId,
      source,
      objects: this.bus.dictionary(number),
    }));
  }

  private apply(input: Input): Added {
    const { bus } = this;
    switch (input.op) {
      case 'add':
        return this.add(input);
      case 'remove':
        bus.removeDevice(input.node);
        this.devices.splice(input.node, 1);
        break;
      case 'send':
        bus.send(input.id, input.data, input.extended, input.remote);
        break;
      case 'repeat':
        bus.repeat(input.key, input.id, input.data, input.extended, input.remote, input.micros);
        break;
      case 'power':
        bus.setPower(input.node, input.on);
        break;
      case 'turn':
        bus.turnTo(input.node, input.turns);
        break;
      case 'rpm':
        bus.follow(input.node, new Float64Array(0), false);
        bus.setRpm(input.node, input.rpm);
        break;
      case 'follow':
        bus.follow(input.node, Float64Array.from(input.steps), input.repeats);
        break;
      case 'switches':
        this.setSwitches(input);
        break;
      case 'fault':
        bus.setFault(input.node, input.name, input.on);
        break;
      case 'line':
        bus.setLine(input.real, input.terminators, input.rate);
        break;
      case 'seed':
        bus.setSeed(input.seed);
        break;
      case 'plug':
        bus.setPlugged(input.station, input.on);
        break;
      case 'restart':
        bus.restartController(input.station);
        break;
      case 'cut':
        bus.cutPowerAfter(input.node, input.bytes);
        break;
      case 'eeprom':
        bus.setEeprom(input.node, input.bytes);
        break;
      case 'deliver':
        bus.deliver(input.node, input.id, input.data);
        break;
      case 'lesson':
        return this.startLesson(input.text);
      case 'leave':
        bus.endLesson();
        this.lesson = null;
        break;
      case 'script':
        try {
          bus.runScript(input.text);
        } catch (error) {
          return { node: null, diagnostics: [fault(error)] };
        }
        break;
    }
    return { node: null, diagnostics: [] };
  }

  /** A lesson begins at zero, and what was before is gone; a wrong one leaves all as it is. */
  private begins(input: Extract<Input, { op: 'lesson' }>): Added {
    const before = { bus: this.bus, devices: this.devices, lesson: this.lesson };
    this.bus = this.fresh();
    const added = this.startLesson(input.text);
    if (added.node === null) {
      this.bus.free();
      Object.assign(this, before);
      return added;
    }
    this.giveUp();
    before.bus.free();
    this.unseen = new Uint8Array(0);
    this.journal = [{ at: 0, input }];
    this.done = 1;
    this.told = 0;
    return added;
  }

  private startLesson(text: string): Added {
    const { lesson, problems } = this.module.parseLesson!(text);
    if (!lesson) {
      return { node: null, diagnostics: problems.map((one) => ({ ...one, code: '', severity: 'error' as const, object: '', fix: null })) };
    }
    try {
      this.bus.startLesson(text);
    } catch (error) {
      return { node: null, diagnostics: [fault(error)] };
    }
    this.lesson = lesson;
    const known = this.module.builtinDevices();
    this.devices = Array.from({ length: this.bus.deviceCount() }, (_, number) => {
      const title = this.bus.title(number);
      const name = known.find((one) => one.title === title)?.name ?? title;
      return { source: { kind: 'builtin' as const, name }, nodeId: this.bus.nodeId(number), name };
    });
    return { node: 0, diagnostics: [] };
  }

  lessonState(): LessonState | null {
    return this.lesson ? this.bus.lesson() : null;
  }

  /** Was a checkpoint reached since the last call? */
  reachedGoal(): boolean {
    // Looking comes first: a switch that was moved counts, too.
    return this.lessonState() !== null && this.bus.lessonEvents().length > 0;
  }

  private setSwitches({ node, id, dip }: Extract<Input, { op: 'switches' }>): void {
    // A link may name a device that is not there.
    if (node >= this.devices.length) return;
    const { nodeSwitch, rateSwitch } = this.bus.status(node);
    const rate = dip ? (dip.on ? rateSwitch | dip.bit : rateSwitch & ~dip.bit) : rateSwitch;
    this.bus.setSwitches(node, id ?? nodeSwitch, rate);
  }

  private add({ source, nodeId, place }: Extract<Input, { op: 'add' }>): Added {
    let node: number | null = null;
    let diagnostics: Diagnostic[] = [];
    let { name } = source;
    try {
      if (source.kind === 'builtin') {
        node = this.bus.addDevice(name, nodeId, place);
      } else {
        const result = this.bus.addEds(source.text, nodeId, source.lenient, place);
        ({ device: node, diagnostics } = result);
        if (node !== null) name = this.bus.title(node);
      }
    } catch (error) {
      diagnostics = [fault(error)];
    }
    if (node !== null) this.devices[node] = { source, nodeId, name };
    // The further channels of a redundant encoder are nodes of their own.
    for (let channel = 2; this.devices.length < this.bus.deviceCount(); channel++) {
      const number = this.devices.length;
      this.devices.push({ source, nodeId: this.bus.nodeId(number), name: `${name}.${channel}` });
    }
    return { node, diagnostics };
  }
}
