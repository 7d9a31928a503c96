// The first minute: start the node, turn the shaft, watch the bytes, begin lesson 1.

import { html, nothing } from 'lit';
import { effect } from '@preact/signals-core';
import { sendLine, setRpm, setRunning } from '../actions';
import { openNamed } from '../lessons/open';
import * as state from '../state';
import { T } from '../texts';
import { icons } from './icons';
import { View } from './view';

const LESSON = 'boot-up-and-heartbeat';

/** Called when the user has done a step, with the button or in another way. */
const DONE = [
  () => state.nmt.value === 'operational',
  () => state.nmt.value === 'operational' && state.shaft.value !== null && (state.shaft.value.rpm !== 0 || Math.abs(state.shaft.value.turns - from) > 0.02),
];
let from = 0;

class Tour extends View {
  private unlook: (() => void) | undefined;

  override connectedCallback(): void {
    super.connectedCallback();
    this.unlook = effect(() => {
      const step = state.tour.value;
      if (step === null || !DONE[step]?.()) return;
      queueMicrotask(() => state.tour.peek() === step && go(step + 1));
    });
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.unlook?.();
  }

  private act(step: number): void {
    setRunning(true);
    if (step === 0) sendLine('nmt start');
    if (step === 1) setRpm(30);
    if (step === 2) go(3);
    if (step === 3) {
      state.tour.value = null;
      void openNamed(LESSON);
    }
  }

  protected override render() {
    const step = state.tour.value;
    const [text, action] = T.tour.steps[step ?? -1] ?? [];
    if (step === null || !text) return nothing;
    return html`<section class="tour" role="region" aria-label=${T.tour.title}>
      <span class="num muted">${T.tour.step(step + 1, T.tour.steps.length)}</span>
      <p aria-live="polite">${text}</p>
      <button class="small primary" @click=${() => this.act(step)}>${action}</button>
      <button class="quiet" aria-label=${T.tour.skip} title=${T.tour.skip} @click=${() => (state.tour.value = null)}>${icons.close}</button>
    </section>`;
  }
}

function go(step: number): void {
  from = state.shaft.peek()?.turns ?? 0;
  state.tour.value = step;
}

customElements.define('od-tour', Tour);
