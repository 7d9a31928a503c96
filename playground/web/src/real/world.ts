// A real bus in the worker: a bench in real time that is connected to a link. Frames of the link are
// received by the bench, and frames of the page are sent.

import type { Applied, Command, Input } from '../sim/api';
import type { Adapter } from '../wasm/od_playground';
import { World, type Module } from '../sim/world';
import type { RealReport, RealState, Target, Why } from './api';
import { ofPage, socket, type Port } from './ports';

/** Milliseconds for a connection, and for responses of an adapter. */
const PATIENCE = 5000;
const ANSWER = 2000;
/** Milliseconds between two attempts to restore a lost link: the first, and the maximum. */
const FIRST_PAUSE = 500;
const LONGEST_PAUSE = 5000;
/** More frames than a slice ever receives. */
const ALL = 1_000_000;

export class Real extends World {
  private readonly adapter: Adapter;
  private readonly start = performance.now();
  private port: Port | null = null;
  private status: 'opening' | 'open' | 'lost' = 'opening';
  private why: Why | null = null;
  private sending = false;
  private unsent = 0;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private pause = FIRST_PAUSE;
  /** Callers that wait for the first connection. */
  private first: ((why: Why | null) => void) | null = null;

  constructor(
    home: World,
    module: Module,
    private readonly to: Target,
    private readonly tell: (what: RealReport) => void,
  ) {
    super(home.modules, module);
    this.adapter = new module.Adapter!();
  }

  protected override fresh() {
    const bus = new this.module.Bus();
    bus.goLive();
    return bus;
  }

  /** Opens the link; null when the bus is open. */
  open(): Promise<Why | null> {
    return new Promise((resolve) => {
      this.first = resolve;
      this.attempt();
    });
  }

  /** Tries again if the link is lost. */
  retry(): void {
    if (this.status === 'lost') this.attempt();
  }

  private attempt(): void {
    this.drop();
    const ears = {
      opened: () => {
        if (port !== this.port) return;
        this.wait(ANSWER, { kind: 'silent' });
        port.write(this.adapter.begin(this.to.kind === 'serial' ? this.to.rate : null));
      },
      came: (bytes: Uint8Array) => {
        if (port === this.port) this.came(bytes);
      },
      ended: (why: Why) => {
        if (port === this.port) this.ended(why);
      },
    };
    this.ears = this.to.kind === 'serial' ? ears : null;
    const port: Port = this.to.kind === 'ws' ? socket(this.to.address, ears) : ofPage(this.tell);
    this.port = port;
    this.wait(PATIENCE, { kind: 'slow' });
    if (this.to.kind === 'serial') ears.opened();
  }

  /** Called for events of the page's port. */
  ears: { came(bytes: Uint8Array): void; ended(why: Why): void } | null = null;

  private wait(millis: number, why: Why): void {
    clearTimeout(this.timer);
    this.timer = setTimeout(() => this.ended(why), millis);
  }

  private drop(): void {
    clearTimeout(this.timer);
    this.port?.close();
    this.port = null;
  }

  private came(bytes: Uint8Array): void {
    this.pass();
    this.adapter.hear(this.bus, bytes);
    if (this.status !== 'open') {
      if (this.adapter.isClosed()) return this.ended({ kind: 'closed' });
      if (this.adapter.isOpen()) this.opened();
    }
    this.flush();
  }

  private opened(): void {
    clearTimeout(this.timer);
    this.status = 'open';
    this.why = null;
    this.pause = FIRST_PAUSE;
    this.first?.(null);
    this.first = null;
  }

  private ended(why: Why): void {
    this.drop();
    this.why = why;
    // After a reconnection nothing is sent before the user allows it.
    this.setSending(false);
    if (this.first) {
      this.first(why);
      this.first = null;
      return;
    }
    this.status = 'lost';
    if (this.to.kind !== 'ws') return;
    this.timer = setTimeout(() => this.attempt(), this.pause);
    this.pause = Math.min(2 * this.pause, LONGEST_PAUSE);
  }

  setSending(on: boolean): void {
    this.sending = on && this.status === 'open';
    this.bus.setSending(this.sending);
  }

  close(): void {
    this.drop();
    this.status = 'opening';
    this.first?.({ kind: 'gone' });
    this.first = null;
  }

  /** Advances time to the present. */
  private pass(): void {
    const now = (performance.now() - this.start) * 1000;
    this.bus.advance(Math.max(0, Math.floor(now - this.bus.now())), ALL);
  }

  follow(): void {
    this.pass();
    this.flush();
  }

  /** Sends the frames of the page. */
  private flush(): void {
    const lines = this.adapter.outgoing(this.bus);
    if (lines.length > 0 && !this.port?.write(lines)) this.miss(lines);
  }

  /** Some lines could not be sent. */
  miss(lines: Uint8Array): void {
    for (const byte of lines) if (byte === 13) this.unsent += 1;
  }

  override async act(input: Input): Promise<Applied> {
    this.pass();
    const added = await super.act(input);
    this.flush();
    return added;
  }

  override transfer(command: Extract<Command, { op: 'transfer' }>): void {
    this.pass();
    super.transfer(command);
    this.flush();
  }

  describe(input: Input): Applied {
    return this.bus.addDescription(input);
  }

  link(): RealState {
    const { adapter, bus } = this;
    return {
      name: this.to.name,
      kind: this.to.kind,
      status: this.status === 'open' ? 'open' : 'lost',
      why: this.why,
      sending: this.sending,
      held: bus.held(),
      dropped: bus.dropped(),
      unsent: this.unsent,
      refused: adapter.refused(),
      noise: adapter.noise(),
      frames: adapter.frames(),
      nodes: [...adapter.nodes()],
    };
  }
}
