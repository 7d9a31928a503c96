// The line in which the user sets a trigger, and its state.

import { html, nothing } from 'lit';
import { signal } from '@preact/signals-core';
import * as state from '../state';
import { View } from '../views/view';
import './style';
import { S } from './texts';
import { arm, disarm, type Settings } from './trigger';

/** The typed text stays when the line is closed. */
const settings = signal<Settings>({ text: '', before: null, after: 100 });

class TriggerBar extends View {
  static override properties = { problem: { state: true } };
  declare problem: { error: string; at: number } | null;

  constructor() {
    super();
    this.problem = null;
  }

  private set(change: Partial<Settings>): void {
    settings.value = { ...settings.value, ...change };
    this.problem = null;
  }

  private arm(event: Event): void {
    event.preventDefault();
    this.problem = arm(settings.value);
  }

  protected override render() {
    const t = S.trigger;
    const { text, before, after } = settings.value;
    const { value: now } = state.trigger;
    const { problem } = this;
    const part = problem ? text.slice(problem.at, problem.at + 16) : '';
    const number = (event: Event): number => Math.max(0, (event.target as HTMLInputElement).valueAsNumber);
    return html`<form class="trigger" novalidate @submit=${(event: Event) => this.arm(event)}>
      <input class="num grow" aria-label=${t.what} placeholder=${t.hint} autocomplete="off" spellcheck="false" aria-invalid=${problem !== null} aria-describedby="trigger-note"
        .value=${text} @input=${(event: Event) => this.set({ text: (event.target as HTMLInputElement).value })}>
      <label>${t.before} <input class="num" type="number" min="0" placeholder=${t.all} aria-label=${t.beforeTitle} title=${t.beforeTitle} .value=${before === null ? '' : String(before)}
        @change=${(event: Event) => { const value = number(event); this.set({ before: Number.isNaN(value) ? null : value }); }}> ms</label>
      <label>${t.after} <input class="num" type="number" min="0" aria-label=${t.afterTitle} title=${t.afterTitle} .value=${String(after)}
        @change=${(event: Event) => this.set({ after: number(event) || 0 })}> ms</label>
      <button class="small primary">${now ? t.again : t.arm}</button>
      ${now ? html`<button type="button" class="small" @click=${disarm}>${now.phase === 'stopped' ? t.goOn : t.disarm}</button>` : nothing}
      <p id="trigger-note" class="note" role="status" data-tone=${problem ? 'error' : ''}>${problem ? html`${part ? html`<code>${part}</code>: ` : nothing}${problem.error}` : (now?.text ?? t.off)}</p>
    </form>`;
  }
}

customElements.define('od-trigger', TriggerBar);
