// The chosen frame in full: its meaning, its bytes with what they are, and ways to use it again.

import { html, nothing } from 'lit';
import { effect } from '@preact/signals-core';
import * as state from '../state';
import { sendFrame } from '../actions';
import { toggleBookmark, trace } from '../capture';
import { fieldsOf, type Field } from '../can/fields';
import { tagOf } from '../can/service';
import { hexByte, hexId, typedForm } from '../can/text';
import { layout } from '../sim/link';
import type { Frame } from '../sim/packed';
import { wordsArrived, wordsOf } from '../sim/words';
import { T } from '../texts';
import { icons } from './icons';
import { addToList } from './send-list';
import { View } from './view';

class FrameDetail extends View {
  static override properties = { mapping: { state: true }, lit: { state: true } };
  /** The mapping of the chosen PDO. */
  declare mapping: Uint32Array;
  /** The field under the pointer. */
  declare lit: Field | null;
  private stopEffect: (() => void) | undefined;

  constructor() {
    super();
    this.mapping = new Uint32Array(0);
    this.lit = null;
  }

  override connectedCallback(): void {
    super.connectedCallback();
    this.stopEffect = effect(() => {
      const number = state.chosenFrame.value;
      this.mapping = new Uint32Array(0);
      this.lit = null;
      if (number === null || !state.ring.get(number)) return;
      void layout(state.ring.raw(number).slice()).then((mapping) => {
        if (state.chosenFrame.value === number) this.mapping = mapping;
      });
    });
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.stopEffect?.();
  }

  /** The fields of a frame, with the names of the device that it is from or for. */
  private fields(frame: Frame): Field[] {
    const node = frame.id & 0x7f;
    const number = frame.device ? frame.device - 1 : state.statuses.peek().findIndex((one) => one.nodeId === node);
    const objects = state.devices.peek()[number]?.objects ?? [];
    return fieldsOf(frame, (index, sub) => objects.find((one) => one.index === index && one.sub === sub), this.mapping);
  }

  private showObject({ object }: Field): void {
    const found = object && state.objectsByKey.value.get(state.keyOf(object.index, object.sub));
    if (!found) return;
    state.selected.value = found;
    state.tab.value = 'objects';
  }

  protected override render() {
    const number = state.chosenFrame.value;
    const frame = number === null ? undefined : state.ring.get(number);
    if (number === null || !frame) return nothing;
    void wordsArrived.value;
    const tag = tagOf(frame);
    const text = typedForm(frame);
    const fields = this.fields(frame);
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
            ${frame.remote ? html`<span>${t.remote}, length ${frame.dlc}</span>` : Array.from(frame.data, (byte, i) => html`<span class="byte" data-lit=${isLit(i)} @pointerenter=${() => (this.lit = fields.find((field) => i >= field.from && i < field.to) ?? null)} @pointerleave=${() => (this.lit = null)}><b>${hexByte(byte)}</b><i>${i}</i></span>`)}
            <span class="muted ascii" title=${T.send.characters}>${String.fromCharCode(...Array.from(frame.data, (byte) => (byte > 31 && byte < 127 ? byte : 0xb7)))}</span>
          </div>`}
      ${fields.length
        ? html`<ul class="fields">${fields.map((field) => html`<li data-lit=${field === this.lit || (this.lit !== null && this.lit.from === field.from)} @pointerenter=${() => (this.lit = field)} @pointerleave=${() => (this.lit = null)}>
            <span class="num muted">${field.to - field.from > 1 ? `${field.from}–${field.to - 1}` : field.from}</span>
            ${field.object && state.objectsByKey.value.has(state.keyOf(field.object.index, field.object.sub)) ? html`<button class="link" @click=${() => this.showObject(field)}>${field.name}</button>` : html`<span>${field.name}</span>`}
            <span class="num">${field.value}</span></li>`)}</ul>`
        : nothing}
      ${fold ? html`<div class="fold num scroll" tabindex="0" role="region" aria-label=${t.fold(fold.frames.length, fold.bytes.length)}>${fold.frames.map((one) => { const part = state.ring.get(one); return part ? html`<div>${part.fromPage ? 'Tx' : 'Rx'} ${typedForm(part)}</div>` : nothing; })}</div>` : nothing}
      <div class="frame-actions">
        ${frame.disturbed
          ? nothing
          : html`<button class="small" title=${`${t.again}: ${text}`} @click=${() => sendFrame({ id: frame.id, extended: frame.extended, remote: frame.remote, data: frame.data.slice(), dlc: frame.dlc })}>${t.again}</button>
            <button class="small" title=${T.send.toLine(text)} @click=${() => (state.draft.value = { text })}>${icons.send} ${t.toLine}</button>
            <button class="small" @click=${() => addToList(text)}>${icons.plus} ${t.toList}</button>`}
        <button class="icon-button" aria-pressed=${isMarked} aria-label=${t.mark} title=${`${t.mark} (B)`} @click=${() => toggleBookmark(number)}>${icons.mark}</button>
        <button class="icon-button" aria-label=${t.close} @click=${() => (state.chosenFrame.value = null)}>${icons.close}</button>
      </div>
    </div>`;
  }
}

customElements.define('od-frame-detail', FrameDetail);
