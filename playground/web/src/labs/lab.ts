// The base of the labs: a view that asks the bench for its state while time passes.

import { effect } from '@preact/signals-core';
import * as state from '../state';
import { add } from '../sim/link';
import { View } from '../views/view';
import './style';

/** Milliseconds between two questions. */
const PERIOD = 120;

export abstract class Lab extends View {
  private timer = 0;
  private end: (() => void) | undefined;

  /** Asks the bench, and draws what changed. */
  protected abstract look(): Promise<void>;

  override connectedCallback(): void {
    super.connectedCallback();
    this.end = effect(() => {
      void state.now.value;
      void state.devices.value;
      this.timer ||= window.setTimeout(() => {
        this.timer = 0;
        void this.look();
      }, PERIOD);
    });
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.end?.();
    clearTimeout(this.timer);
    this.timer = 0;
  }

  /** Plays lines; returns the number of the line that failed and why, or null. Lines that cannot be read are not played. */
  protected async play(lines: string[]): Promise<{ line: number; why: string } | null> {
    const { diagnostics } = await add({ op: 'script', text: lines.join('\n') });
    void this.look();
    const [first] = diagnostics;
    if (!first) return null;
    const [, line, why] = /^(?:line )?(\d+)(?::\d+:| [^\n]*\n)\s*([\s\S]*)$/.exec(first.message) ?? [];
    return { line: Number(line ?? 1), why: why ?? first.message };
  }
}
