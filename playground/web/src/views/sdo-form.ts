// Reads and writes an object by name or index, over the bus.

import { html, nothing } from 'lit';
import { effect } from '@preact/signals-core';
import type { ObjectRecord } from '../sim/api';
import { encode } from '../codec';
import { address, showValue } from '../format';
import { inWords, transfer, type Message } from '../sim/sdo';
import * as state from '../state';
import { T } from '../texts';
import { findObjects, parseAddress, standIn } from './object-search';
import { View, withCode } from './view';

const MOST_OFFERED = 30;

class SdoForm extends View {
  static override properties = { text: { state: true }, typed: { state: true }, result: { state: true }, offered: { state: true }, active: { state: true }, isBusy: { state: true } };
  declare text: string;
  declare typed: string;
  declare result: Message | null;
  declare offered: ObjectRecord[];
  declare active: number;
  declare isBusy: boolean;
  private effects: (() => void)[] = [];

  constructor() {
    super();
    this.text = '';
    this.typed = '';
    this.result = null;
    this.offered = [];
    this.active = -1;
    this.isBusy = false;
  }

  override connectedCallback(): void {
    super.connectedCallback();
    this.effects.push(
      effect(() => {
        const object = state.selected.value;
        if (object) this.choose(object);
      }),
      // A response belongs to one device and one moment.
      effect(() => {
        void state.device.value;
        this.result = null;
      }),
    );
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    for (const stop of this.effects.splice(0)) stop();
  }

  private choose(object: ObjectRecord): void {
    this.text = labelOf(object);
    this.offered = [];
    this.active = -1;
    this.result = null;
    this.typed = '';
  }

  /** The object that the text names; an object outside the dictionary has 32 bits. */
  private target(): ObjectRecord | null {
    const where = parseAddress(this.text);
    if (where) {
      const known = state.objectsByKey.value.get(state.keyOf(where.index, where.sub));
      return known ?? standIn({ ...where, name: '', type: '?', bits: 32 });
    }
    const wanted = this.text.trim().toLowerCase();
    const all = state.device.value?.objects ?? [];
    return all.find((object) => object.name.toLowerCase() === wanted) ?? null;
  }

  private onInput(text: string): void {
    this.text = text;
    this.result = null;
    this.active = -1;
    this.offered = text.trim() === '' ? [] : findObjects(state.device.value?.objects ?? [], text).slice(0, MOST_OFFERED);
  }

  private onKey(event: KeyboardEvent): void {
    const { offered } = this;
    if (event.key === 'Escape') {
      this.offered = [];
    } else if ((event.key === 'ArrowDown' || event.key === 'ArrowUp') && offered.length > 0) {
      event.preventDefault();
      const move = event.key === 'ArrowDown' ? 1 : -1;
      this.active = (this.active + move + offered.length) % offered.length;
      void this.updateComplete.then(() => this.querySelector('[aria-selected=true]')?.scrollIntoView({ block: 'nearest' }));
    } else if (event.key === 'Enter') {
      const object = offered[this.active] ?? (this.target() ? undefined : offered[0]);
      event.preventDefault();
      if (object) this.choose(object);
      // Enter in the object field reads; in the value field it writes.
      if (!object || this.active < 0) void this.read();
    }
  }

  private async read(): Promise<void> {
    const object = this.target();
    this.offered = [];
    if (!object) {
      this.result = { tone: 'error', text: T.sdo.what };
      return;
    }
    await this.run(object, null);
  }

  private async write(): Promise<void> {
    const object = this.target();
    if (!object) {
      await this.read();
      return;
    }
    const encoded = encode(this.typed, object);
    if ('error' in encoded) {
      this.result = { tone: 'error', text: encoded.error };
      return;
    }
    await this.run(object, encoded.bytes);
  }

  private async run(object: ObjectRecord, bytes: Uint8Array | null): Promise<void> {
    this.isBusy = true;
    this.result = state.running.value ? null : { tone: '', text: T.sdo.paused };
    const outcome = await transfer(object, bytes);
    this.isBusy = false;
    this.result = inWords(object, bytes !== null, outcome);
  }

  protected override render() {
    const object = this.target();
    const encoded = object && this.typed.trim() ? encode(this.typed, object) : null;
    const isWrong = encoded !== null && 'error' in encoded;
    const note = this.result?.text ?? (encoded ? ('error' in encoded ? encoded.error : encoded.note) : object ? hint(object) : '');
    const tone = this.result?.tone ?? (isWrong ? 'error' : '');
    const isOpen = this.offered.length > 0;
    return html`<form class="dock-row" novalidate @submit=${(event: Event) => event.preventDefault()}>
      <label class="dock-label" for="sdo-object">${T.sdo.label}</label>
      <div class="field-group">
        <div class="combo grow">
          <input id="sdo-object" role="combobox" autocomplete="off" spellcheck="false" aria-label=${T.sdo.object} aria-expanded=${isOpen} aria-controls="sdo-options"
            aria-autocomplete="list" aria-activedescendant=${this.active >= 0 ? `sdo-option-${this.active}` : nothing} placeholder=${T.sdo.objectHint}
            .value=${this.text} @input=${(event: Event) => this.onInput((event.target as HTMLInputElement).value)} @keydown=${this.onKey}
            @focus=${(event: Event) => (event.target as HTMLInputElement).select()} @blur=${() => setTimeout(() => (this.offered = []), 150)}>
          ${isOpen
            ? html`<ul id="sdo-options" class="options scroll" role="listbox" aria-label=${T.sdo.objects}>
                ${this.offered.map(
                  (one, i) => html`<li id=${`sdo-option-${i}`} role="option" aria-selected=${i === this.active}
                    @pointerdown=${(event: Event) => { event.preventDefault(); this.choose(one); }}>
                    <span class="num">${address(one.index, one.sub)}</span><span>${one.name}${one.parent ? html`<span class="muted"> – ${one.parent}</span>` : nothing}</span><span class="muted">${one.access}</span>
                  </li>`,
                )}
              </ul>`
            : nothing}
        </div>
        <button type="button" ?disabled=${this.isBusy} @click=${() => this.read()}>${T.sdo.read}</button>
        <input class="num value" aria-label=${T.sdo.value} autocomplete="off" spellcheck="false" placeholder=${T.sdo.value} aria-invalid=${isWrong} aria-describedby="sdo-note"
          .value=${this.typed} @input=${(event: Event) => { this.typed = (event.target as HTMLInputElement).value; this.result = null; }}
          @keydown=${(event: KeyboardEvent) => { if (event.key === 'Enter' && !this.isBusy) { event.preventDefault(); void (this.typed.trim() ? this.write() : this.read()); } }}>
        <button type="button" ?disabled=${this.isBusy || isWrong} @click=${() => this.write()}>${T.sdo.write}</button>
        <p id="sdo-note" class="note" data-tone=${tone} role="status">${note || withCode(T.sdo.hint)}</p>
      </div>
    </form>`;
  }
}

const labelOf = (object: ObjectRecord): string => `${address(object.index, object.sub, object.parent !== null)} ${object.name}`;

function hint(object: ObjectRecord): string {
  if (object.type === '?') return T.sdo.unknown;
  const limits = object.low !== null || object.high !== null ? `, ${showValue(object.low, object)} … ${showValue(object.high, object)}` : '';
  return `${object.type}, ${object.access}${limits}`;
}

customElements.define('od-sdo-form', SdoForm);
