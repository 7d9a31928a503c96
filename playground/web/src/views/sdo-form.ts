// Reading and writing an object by its name or index, over the bus.

import { html, nothing } from 'lit';
import { effect } from '@preact/signals-core';
import type { ObjectRecord } from '../sim/api';
import { address, decode, encode, otherSpelling, showValue } from '../can/values';
import type { Outcome } from '../can/sdo';
import { silence, transfer } from '../sim/client';
import { describe } from '../sim/link';
import { pack } from '../sim/packed';
import * as state from '../state';
import { findObjects, parseAddress } from './object-search';
import { View } from './view';

const MOST_OFFERED = 30;

type Result = { tone: '' | 'error' | 'good'; text: string };

class SdoForm extends View {
  static override properties = { text: { state: true }, typed: { state: true }, result: { state: true }, offered: { state: true }, active: { state: true }, isBusy: { state: true } };
  declare text: string;
  declare typed: string;
  declare result: Result | null;
  declare offered: ObjectRecord[];
  declare active: number;
  declare isBusy: boolean;
  private unselect: (() => void) | undefined;

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
    this.unselect = effect(() => {
      const object = state.selected.value;
      if (object) this.choose(object);
    });
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.unselect?.();
  }

  private choose(object: ObjectRecord): void {
    this.text = labelOf(object);
    this.offered = [];
    this.active = -1;
    this.result = null;
    this.typed = '';
  }

  /** The object that the text names; one outside the dictionary is taken for 32 bits. */
  private target(): ObjectRecord | null {
    const where = parseAddress(this.text);
    if (where) {
      const known = state.objectsByKey.value.get(state.keyOf(where.index, where.sub));
      return known ?? unknownObject(where.index, where.sub);
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
      if (object) {
        event.preventDefault();
        this.choose(object);
      }
    }
  }

  private async read(): Promise<void> {
    const object = this.target();
    this.offered = [];
    if (!object) {
      this.result = { tone: 'error', text: 'Type an index, such as 6004 or 1018:01, or choose a name' };
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
    this.result = state.running.value ? null : { tone: '', text: 'Time stands still: the answer comes when it runs.' };
    const outcome = await transfer({ index: object.index, sub: object.sub, bytes });
    this.isBusy = false;
    this.result = await this.inWords(object, outcome);
  }

  private async inWords(object: ObjectRecord, outcome: Outcome): Promise<Result> {
    const where = address(object.index, object.sub);
    switch (outcome.kind) {
      case 'read': {
        const value = decode(outcome.bytes, object);
        const other = otherSpelling(value, object);
        return { tone: 'good', text: `${where} = ${showValue(value, object)}${other ? ` (${other})` : ''}` };
      }
      case 'written':
        return { tone: 'good', text: `${where} written` };
      case 'silent':
        return { tone: 'error', text: silence() };
      case 'aborted': {
        const data = new Uint8Array(8);
        data.set([0x80, object.index & 255, object.index >> 8, object.sub]);
        new DataView(data.buffer).setUint32(4, outcome.code, true);
        const [words] = await describe(pack({ time: 0, id: 0x580 + state.nodeId.value, extended: false, remote: false, fromPage: false, data }));
        return { tone: 'error', text: words || `Aborted: ${outcome.code.toString(16).toUpperCase().padStart(8, '0')}h` };
      }
    }
  }

  protected override render() {
    const object = this.target();
    const encoded = object && this.typed.trim() ? encode(this.typed, object) : null;
    const isWrong = encoded !== null && 'error' in encoded;
    const note = this.result?.text ?? (encoded ? ('error' in encoded ? encoded.error : encoded.note) : object ? hint(object) : '');
    const tone = this.result?.tone ?? (isWrong ? 'error' : '');
    const isOpen = this.offered.length > 0;
    return html`<form class="dock-row" novalidate @submit=${(event: Event) => { event.preventDefault(); void (this.typed.trim() ? this.write() : this.read()); }}>
      <label class="dock-label" for="sdo-object">SDO</label>
      <div class="field-group">
        <div class="combo grow">
          <input id="sdo-object" role="combobox" autocomplete="off" spellcheck="false" aria-label="Object" aria-expanded=${isOpen} aria-controls="sdo-options"
            aria-autocomplete="list" aria-activedescendant=${this.active >= 0 ? `sdo-option-${this.active}` : nothing} placeholder="Object: index or name"
            .value=${this.text} @input=${(event: Event) => this.onInput((event.target as HTMLInputElement).value)} @keydown=${this.onKey}
            @focus=${(event: Event) => (event.target as HTMLInputElement).select()} @blur=${() => setTimeout(() => (this.offered = []), 150)}>
          ${isOpen
            ? html`<ul id="sdo-options" class="options scroll" role="listbox" aria-label="Objects">
                ${this.offered.map(
                  (one, i) => html`<li id=${`sdo-option-${i}`} role="option" aria-selected=${i === this.active}
                    @pointerdown=${(event: Event) => { event.preventDefault(); this.choose(one); }}>
                    <span class="num">${address(one.index, one.sub)}</span><span>${one.name}${one.parent ? html`<span class="muted"> – ${one.parent}</span>` : nothing}</span><span class="muted">${one.access}</span>
                  </li>`,
                )}
              </ul>`
            : nothing}
        </div>
        <button type="button" ?disabled=${this.isBusy} @click=${() => this.read()}>Read</button>
        <input class="num value" aria-label="Value" autocomplete="off" spellcheck="false" placeholder="Value" aria-invalid=${isWrong} aria-describedby="sdo-note"
          .value=${this.typed} @input=${(event: Event) => { this.typed = (event.target as HTMLInputElement).value; this.result = null; }}>
        <button type="button" ?disabled=${this.isBusy || isWrong} @click=${() => this.write()}>Write</button>
        <p id="sdo-note" class="note" data-tone=${tone} role="status">${note || html`Decimal, <code>0x1F</code> or <code>1Fh</code>; quotes for text, such as <code>"save"</code>`}</p>
      </div>
    </form>`;
  }
}

const labelOf = (object: ObjectRecord): string => `${address(object.index, object.sub, object.parent !== null)} ${object.name}`;

function hint(object: ObjectRecord): string {
  if (object.type === '?') return 'Not in the dictionary of this device';
  const limits = object.low !== null || object.high !== null ? `, ${showValue(object.low, object)} … ${showValue(object.high, object)}` : '';
  return `${object.type}, ${object.access}${limits}`;
}

const unknownObject = (index: number, sub: number): ObjectRecord => ({
  index, sub, name: '', parent: null, type: '?', bits: 32, access: 'rw', mappable: false, default: null, low: null, high: null,
});

customElements.define('od-sdo-form', SdoForm);
