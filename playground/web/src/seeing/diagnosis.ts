// The faults in the frames of the capture, with their likely causes. A click on a frame shows it in the console.

import { html, nothing } from 'lit';
import * as state from '../state';
import { reveal, view } from '../capture';
import { hexBytes, hexId } from '../format';
import type { Incident } from '../sim/api';
import { use } from '../sim/link';
import { wordsArrived, wordsOf } from '../sim/words';
import { T } from '../texts';
import { View } from '../views/view';
import './style';
import { S } from './texts';

/** A diagnosis: the number of the first frame, the number of frames, whether they have times, the faults, and why they are not CANopen. */
interface Found {
  first: number;
  count: number;
  timed: boolean;
  incidents: Incident[];
  other: string;
}

class Diagnosis extends View {
  static override properties = { found: { state: true }, error: { state: true } };
  declare found: Found | null;
  declare error: string;

  constructor() {
    super();
    this.found = null;
    this.error = '';
  }

  override connectedCallback(): void {
    super.connectedCallback();
    void this.look();
  }

  private async look(): Promise<void> {
    const { first, end } = state.ring;
    const line = state.line.peek();
    this.found = null;
    this.error = '';
    const timed = end - first < 2 || state.ring.get(first)?.time !== state.ring.get(end - 1)?.time;
    const answer = await use('diagnose', state.ring.slice(first, end), line?.real ? (line.rate ?? undefined) : undefined);
    if ('error' in answer) this.error = answer.error;
    else this.found = { first, count: end - first, timed, ...answer.value };
  }

  protected override render() {
    const { found, error } = this;
    const t = S.diagnosis;
    const said = error || (found ? t.found(found.incidents.length, found.count) : t.running);
    return html`<div class="diagnosis scroll" tabindex="0" role="region" aria-label=${T.frames.diagnosis}>
      <p class="note" role="status" data-tone=${error ? 'error' : nothing}>${said}
        <button class="small" ?disabled=${!found && !error} @click=${() => void this.look()}>${t.again}</button></p>
      ${found?.other ? html`<p class="note">${t.other(found.other)}</p>` : nothing}
      ${found && !found.timed ? html`<p class="note">${t.untimed}</p>` : nothing}
      ${found ? html`<ol>${found.incidents.map((one) => this.incident(one, found))}</ol>` : nothing}
    </div>`;
  }

  private incident({ text, span, causes, frames }: Incident, { first, timed }: Found) {
    void wordsArrived.value;
    const numbers = frames.map((place) => first + place);
    const words = wordsOf(numbers);
    const t = S.diagnosis;
    return html`<li>
      <h3>${text}</h3>
      <p class="muted num">${span}</p>
      <ol type="a">${causes.map((cause) => html`<li>${cause.text}. <span class="muted"><b>${t.check}:</b> ${cause.check}</span></li>`)}</ol>
      <ul aria-label=${t.frames}>${numbers.map((number, i) => this.frame(number, words[i] ?? '', timed))}</ul>
    </li>`;
  }

  private frame(number: number, words: string, timed: boolean) {
    const frame = state.ring.get(number);
    if (!frame) return html`<li class="muted">${S.diagnosis.gone}</li>`;
    const bytes = frame.disturbed ? '' : `${hexId(frame.id, frame.extended)} ${frame.remote ? T.frames.remote : hexBytes(frame.data)}`;
    const time = timed ? `${(frame.time / 1e6).toFixed(6)} ` : '';
    return html`<li><button class="link num" @click=${() => { view.value = 'order'; reveal(number); }}>${time}${bytes}</button> ${words}</li>`;
  }
}

customElements.define('od-diagnosis', Diagnosis);
