// The area below the frames: a raw frame, an SDO by name, and the NMT commands.

import { html } from 'lit';
import { keyed } from 'lit/directives/keyed.js';
import { effect } from '@preact/signals-core';
import * as state from '../state';
import { doLine, isDeed, readTyped, sendFrame, sendLine } from '../actions';
import { templates } from '../codec';
import { typedForm } from '../format';
import { said } from '../language';
import { askBus } from '../sim/link';
import { pack, unpack } from '../sim/packed';
import { icons } from './icons';
import { View, withCode } from './view';
import './sdo-form';
import { addToList } from './send-list';
import { T } from '../texts';

const MOST_REMEMBERED = 50;

class Send extends View {
  protected override render() {
    return html`
      ${keyed(state.lessonRun.value.count, html`<od-raw-frame></od-raw-frame><od-sdo-form></od-sdo-form>`)}
      <div class="dock-row">
        <span class="dock-label" id="nmt-label">NMT</span>
        <div class="button-row" role="group" aria-labelledby="nmt-label">
          ${T.nmt.map(
            ({ line, to, text, title }) => html`<button class="small" title=${title} aria-label=${`NMT ${text}`} data-active=${to === state.nmt.value} @click=${() => sendLine(line)}>${text}</button>`,
          )}
          <span class="spacer"></span>
          <label class="select bordered templates" title=${T.sendList.templates}><select aria-label=${T.sendList.templates} @change=${(event: Event) => {
            const select = event.target as HTMLSelectElement;
            if (select.value) state.draft.value = { text: select.value };
            select.value = '';
          }}><option value="">${T.sendList.more}</option>${templates(state.nodeId.value).map(({ name, frame }) => html`<option value=${typedForm(unpack(frame, 0))}>${name}</option>`)}</select></label>
          <button class="small" title=${T.send.sync} @click=${() => sendLine('sync')}>SYNC</button>
        </div>
      </div>
      <od-send-list></od-send-list>
    `;
  }
}

/** The line for a frame in hexadecimal, with its meaning while it is typed. */
class RawFrame extends View {
  static override properties = { text: { state: true }, meaning: { state: true }, isTouched: { state: true } };
  declare text: string;
  declare meaning: string;
  declare isTouched: boolean;
  private history: string[] = [];
  private place = 0;
  private undraft: (() => void) | undefined;

  constructor() {
    super();
    this.text = '';
    this.meaning = '';
    this.isTouched = false;
  }

  override connectedCallback(): void {
    super.connectedCallback();
    this.undraft = effect(() => {
      const { value } = state.draft;
      if (!value) return;
      void this.onInput(value.text);
      this.querySelector('input')?.focus();
    });
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.undraft?.();
  }

  private async onInput(text: string): Promise<void> {
    this.text = text;
    this.isTouched = false;
    const parsed = readTyped(text);
    if ('error' in parsed) {
      this.meaning = '';
      return;
    }
    const { frame } = parsed;
    const typed = pack({ ...frame, data: frame.remote ? new Uint8Array(0) : frame.data, dlc: frame.data.length, time: 0, fromPage: true });
    const words = await askBus('describeAll', typed);
    if (this.text === text) this.meaning = said(words?.[0] ?? '');
  }

  private submit(event: Event): void {
    event.preventDefault();
    const parsed = readTyped(this.text);
    this.isTouched = true;
    if (isDeed(this.text)) void doLine(this.text);
    else if ('error' in parsed) return;
    else sendFrame(parsed.frame);
    if (this.history.at(-1) !== this.text) this.history = [...this.history, this.text].slice(-MOST_REMEMBERED);
    this.place = this.history.length;
    this.querySelector('input')?.select();
  }

  private onKey(event: KeyboardEvent): void {
    const move = event.key === 'ArrowUp' ? -1 : event.key === 'ArrowDown' ? 1 : 0;
    if (move === 0 || this.history.length === 0) return;
    event.preventDefault();
    this.place = Math.max(0, Math.min(this.history.length, this.place + move));
    void this.onInput(this.history[this.place] ?? '');
  }

  protected override render() {
    const parsed = readTyped(this.text);
    const isEmpty = this.text.trim() === '';
    const deed = isDeed(this.text);
    const error = !deed && 'error' in parsed && (!isEmpty || this.isTouched) ? parsed.error : '';
    const bytes = 'frame' in parsed ? T.send.bytes(parsed.frame.data.length) : '';
    const example = readTyped('read 6004');
    return html`<form class="dock-row" @submit=${this.submit} novalidate>
      <label class="dock-label" for="raw-frame">${T.send.frame}</label>
      <div class="field-group">
        <input id="raw-frame" class="num grow" autocomplete="off" autocapitalize="off" spellcheck="false" enterkeyhint="send"
          placeholder=${'frame' in example ? typedForm(example.frame) : ''} aria-describedby="raw-note" aria-invalid=${error !== ''}
          .value=${this.text} @input=${(event: Event) => void this.onInput((event.target as HTMLInputElement).value)} @keydown=${this.onKey}>
        <button type="button" class="icon-button" aria-label=${T.frames.toList} title=${T.frames.toList} ?disabled=${'error' in parsed} @click=${() => addToList(this.text)}>${icons.plus}</button>
        <button class="primary" ?disabled=${'error' in parsed && !deed && !isEmpty}>${icons.send} ${T.send.send}</button>
        <p id="raw-note" class="note" data-tone=${error ? 'error' : ''} aria-live="polite">${error || (deed ? T.send.deed : isEmpty ? withCode(T.send.hint) : html`${this.meaning}<span class="muted num"> ${bytes}</span>`)}</p>
      </div>
    </form>`;
  }
}

customElements.define('od-raw-frame', RawFrame);
customElements.define('od-send', Send);
