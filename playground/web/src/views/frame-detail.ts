// The selected frame in detail: its meaning, the meaning of its bytes, and actions with it.

import { html, nothing } from 'lit';
import { effect } from '@preact/signals-core';
import * as state from '../state';
import { sendFrame } from '../actions';
import { toggleBookmark, trace } from '../capture';
import { hexByte, hexId, typedForm } from '../format';
import { askBus } from '../sim/link';
import { wordsArrived, wordsOf } from '../sim/words';
import { T } from '../texts';
import type { Field } from '../sim/api';
import { icons } from './icons';
import { addToList } from './send-list';
import { View } from './view';

class FrameDetail extends View {
  static override properties = { fields: { state: true }, lit: { state: true }, hasBits: { state: true } };
  /** The fields of the selected frame. */
  declare fields: Field[];
  /** The field under the pointer. */
  declare lit: Field | null;
  /** Whether the bits are shown below. */
  declare hasBits: boolean;
  private stopEffect: (() => void) | undefined;

  constructor() {
    super();
    this.fields = [];
    this.lit = null;
    this.hasBits = false;
  }

  /** The view of the bits is loaded on request. */
  private showBits(): void {
    this.hasBits = !this.hasBits;
    import('./bits').catch(() => (state.toast.value = { text: T.bits.unloaded, tone: 'error' }));
  }

  /** Marks the field of a byte, or the byte if no field is known. */
  private mark(byte: number | null): void {
    const bare: Field | null = byte === null ? null : { from: byte, to: byte + 1, name: '', value: '', object: null };
    this.lit = this.fields.find((field) => byte !== null && byte >= field.from && byte < field.to) ?? bare;
  }

  override connectedCallback(): void {
    super.connectedCallback();
    this.stopEffect = effect(() => {
      const number = state.chosenFrame.value;
      this.fields = [];
      this.lit = null;
      if (number === null || !state.ring.get(number)) return;
      void askBus('fields', state.ring.raw(number).slice()).then((fields) => {
        if (state.chosenFrame.value === number) this.fields = fields ?? [];
      });
    });
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.stopEffect?.();
  }

  private showObject({ object }: Field): void {
    const found = object === null ? undefined : state.objectsByKey.value.get(object);
    if (!found) return;
    state.selected.value = found;
    state.tab.value = 'objects';
  }

  protected override render() {
    const number = state.chosenFrame.value;
    const frame = number === null ? undefined : state.ring.get(number);
    if (number === null || !frame) return nothing;
    void wordsArrived.value;
    const tag = frame.tag;
    const text = typedForm(frame);
    const { fields } = this;
    const fold = trace.fold(number);
    const isMarked = state.bookmarks.value.has(number);
    const t = T.frames;
    const isLit = (i: number): boolean => this.lit !== null && i >= this.lit.from && i < this.lit.to;
    return html`<div class="frame-detail" data-service=${tag.service}>
      <div class="frame-words"><b class="tag-text">${tag.text}</b> <span>${wordsOf([number])[0] ?? ''}</span></div>
      ${frame.disturbed
        ? nothing
        : html`<div class="frame-bytes num">
            <span class="muted">${hexId(frame.id, frame.extended)}</span>
            ${frame.remote ? html`<span>${t.remote}, length ${frame.dlc}</span>` : Array.from(frame.data, (byte, i) => html`<span class="byte" data-lit=${isLit(i)} @pointerenter=${() => this.mark(i)} @pointerleave=${() => (this.lit = null)}><b>${hexByte(byte)}</b><i>${i}</i></span>`)}
            <span class="muted ascii" title=${T.send.characters}>${String.fromCharCode(...Array.from(frame.data, (byte) => (byte > 31 && byte < 127 ? byte : 0xb7)))}</span>
          </div>`}
      ${fields.length
        ? html`<ul class="fields">${fields.map((field) => html`<li data-lit=${field === this.lit || (this.lit !== null && this.lit.from === field.from)} @pointerenter=${() => (this.lit = field)} @pointerleave=${() => (this.lit = null)}>
            <span class="num muted">${field.to - field.from > 1 ? `${field.from}–${field.to - 1}` : field.from}</span>
            ${field.object !== null && state.objectsByKey.value.has(field.object) ? html`<button class="link" @click=${() => this.showObject(field)}>${field.name}</button>` : html`<span>${field.name}</span>`}
            <span class="num">${field.value}</span></li>`)}</ul>`
        : nothing}
      ${this.hasBits && !frame.disturbed ? html`<od-bits .frame=${state.ring.raw(number).slice()} .lit=${this.lit ? [this.lit.from, this.lit.to] : null} @byte=${(event: CustomEvent<number | null>) => this.mark(event.detail)}></od-bits>` : nothing}
      ${fold ? html`<div class="fold num scroll" tabindex="0" role="region" aria-label=${t.fold(fold.frames.length, fold.bytes.length)}>${fold.frames.map((one) => { const part = state.ring.get(one); return part ? html`<div>${part.fromPage ? 'Tx' : 'Rx'} ${typedForm(part)}</div>` : nothing; })}</div>` : nothing}
      <div class="frame-actions">
        ${frame.disturbed
          ? nothing
          : html`<button class="small" title=${`${t.again}: ${text}`} @click=${() => sendFrame({ ...frame, data: frame.remote ? new Uint8Array(frame.dlc) : frame.data.slice() })}>${t.again}</button>
            <button class="small" title=${T.send.toLine(text)} @click=${() => (state.draft.value = { text })}>${icons.send} ${t.toLine}</button>
            <button class="small" aria-pressed=${this.hasBits} title=${T.bits.title} @click=${this.showBits}>${T.bits.show}</button>
            <button class="small" @click=${() => addToList(text)}>${icons.plus} ${t.toList}</button>`}
        <button class="icon-button" aria-pressed=${isMarked} aria-label=${t.mark} title=${`${t.mark} (B)`} @click=${() => toggleBookmark(number)}>${icons.mark}</button>
        <button class="icon-button" aria-label=${t.close} @click=${() => (state.chosenFrame.value = null)}>${icons.close}</button>
      </div>
    </div>`;
  }
}

customElements.define('od-frame-detail', FrameDetail);
