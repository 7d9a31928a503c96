// The selected object: its EDS entry, its current and saved value, and a line to write it.

import { html, nothing } from 'lit';
import { effect } from '@preact/signals-core';
import type { ObjectRecord } from '../sim/api';
import { setFilter } from '../capture';
import { encode, range } from '../codec';
import { address, otherSpelling, showValue } from '../format';
import { askBus } from '../sim/link';
import { inWords, transfer, type Message } from '../sim/sdo';
import * as state from '../state';
import { T } from '../texts';
import { icons } from './icons';
import { View } from './view';

/** The editor is loaded on request. */
export const openMapping = (index: number): void => void import('./mapping').then(() => (state.mappingDialog.value = index));

class ObjectDetail extends View {
  static override properties = { typed: { state: true }, said: { state: true }, isBusy: { state: true } };
  declare typed: string;
  declare said: Message | null;
  declare isBusy: boolean;
  private unselect: (() => void) | undefined;

  constructor() {
    super();
    this.typed = '';
    this.said = null;
    this.isBusy = false;
  }

  override connectedCallback(): void {
    super.connectedCallback();
    this.unselect = effect(() => {
      void state.selected.value;
      this.typed = '';
      this.said = null;
    });
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.unselect?.();
  }

  private async run(object: ObjectRecord, bytes: Uint8Array | null): Promise<void> {
    this.isBusy = true;
    this.said = state.running.value ? null : { tone: '', text: T.sdo.paused };
    const outcome = await transfer(object, bytes);
    this.isBusy = false;
    if (state.selected.peek() === object) this.said = inWords(object, bytes !== null, outcome);
  }

  private write(object: ObjectRecord): void {
    const encoded = encode(this.typed, object);
    if ('error' in encoded) this.said = { tone: 'error', text: encoded.error };
    else void this.run(object, encoded.bytes);
  }

  protected override render() {
    const object = state.selected.value;
    if (!object) return nothing;
    const t = T.objects;
    const live = state.values.value.get(state.keyOf(object.index, object.sub)) ?? null;
    const limits = range(object);
    const other = otherSpelling(live, object);
    const saved = state.savedValue.value;
    return html`<div class="detail">
      <div class="detail-head">
        <strong><span class="num">${address(object.index, object.sub, object.parent !== null)}</span> ${object.name}</strong>
        <div class="spacer"></div>
        ${object.isMapping ? html`<button class="small" aria-haspopup="dialog" @click=${() => openMapping(object.index)}>${t.editMapping}</button>` : nothing}
        <button class="small tabs-only" @click=${() => (state.tab.value = 'console')}>${t.sdo}</button>
        <button class="small" title=${t.framesTitle} @click=${() => showFrames(object)}>${t.frames}</button>
        <button class="icon-button" aria-label=${t.close} @click=${() => (state.selected.value = null)}>${icons.close}</button>
      </div>
      <dl>
        <div><dt>${t.value}</dt><dd class="num" aria-label=${t.valueLabel}>${showValue(live, object)}${other ? html` <span class="muted">${other}</span>` : nothing}</dd></div>
        <div><dt>${t.type}</dt><dd>${object.type}</dd></div>
        <div><dt>${t.saved}</dt><dd class="num">${showValue(saved, object)}</dd></div>
        <div><dt>${t.access}</dt><dd>${object.access}${object.mappable ? ', PDO' : ''}</dd></div>
        <div><dt>${t.default}</dt><dd class="num">${showValue(object.default, object)}</dd></div>
        <div><dt>${t.range}</dt><dd class="num">${limits ? `${showValue(limits.low, object)} … ${showValue(limits.high, object)}` : '–'}</dd></div>
      </dl>
      ${this.form(object)}
    </div>`;
  }

  private form(object: ObjectRecord) {
    const t = T.objects;
    const encoded = this.typed.trim() ? encode(this.typed, object) : null;
    const isWrong = encoded !== null && 'error' in encoded;
    const said = this.said ?? (encoded ? { tone: isWrong ? 'error' : '', text: 'error' in encoded ? encoded.error : encoded.note } : null);
    return html`<form class="detail-form" novalidate @submit=${(event: Event) => { event.preventDefault(); this.write(object); }}>
      <input class="num" aria-label=${t.newValue} placeholder=${t.newValue} autocomplete="off" spellcheck="false" aria-invalid=${isWrong} aria-describedby="detail-note"
        .value=${this.typed} @input=${(event: Event) => { this.typed = (event.target as HTMLInputElement).value; this.said = null; }}>
      <button class="small" ?disabled=${this.isBusy || isWrong || encoded === null}>${t.write}</button>
      <button class="small" type="button" ?disabled=${this.isBusy} @click=${() => this.run(object, null)}>${t.read}</button>
      <p id="detail-note" class="note" role="status" data-tone=${said?.tone ?? ''}>${said?.text ?? ''}</p>
    </form>`;
  }
}

/** The SDO transfers of an object, and the PDOs that contain it. */
async function showFrames({ index, sub, parent, mappable }: ObjectRecord): Promise<void> {
  const hex = (value: number, width: number): string => value.toString(16).toUpperCase().padStart(width, '0');
  const terms = [`node:${state.nodeId.peek()} object:${hex(index, 4)}${parent === null ? '' : `:${hex(sub, 2)}`}`];
  if (mappable) {
    const pdos = (await askBus('pdos', state.selectedNode.peek())) ?? [];
    const carry = pdos.filter(({ entries }) => entries.some((one) => one.index === index && one.sub === sub));
    for (const { cobId } of carry) if (cobId?.valid) terms.push(`id:${hex(cobId.id, 3)}`);
  }
  if (index === 0x1001 || index === 0x1003) terms.push(`node:${state.nodeId.peek()} emcy`);
  setFilter(terms.join(' or '));
  state.tab.value = 'console';
}

customElements.define('od-object-detail', ObjectDetail);
