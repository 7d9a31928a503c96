// The chosen frame in full: its meaning, its bytes, and a way to send it again.

import { html, nothing } from 'lit';
import * as state from '../state';
import { tagOf } from '../can/service';
import { hexByte, hexId, typedForm } from '../can/text';
import { wordsArrived, wordsOf } from '../sim/words';
import { icons } from './icons';
import { View } from './view';

class FrameDetail extends View {
  protected override render() {
    const number = state.chosenFrame.value;
    const frame = number === null ? undefined : state.ring.get(number);
    if (number === null || !frame) return nothing;
    void wordsArrived.value;
    const tag = tagOf(frame);
    const text = typedForm(frame);
    return html`<div class="frame-detail" data-service=${tag.service}>
      <div class="frame-words"><b class="tag-text">${tag.text}</b> <span>${wordsOf([number])[0] ?? ''}</span></div>
      <div class="frame-bytes num">
        <span class="muted">${hexId(frame.id, frame.extended)}</span>
        ${frame.remote ? html`<span>remote request, length ${frame.dlc}</span>` : Array.from(frame.data, (byte, i) => html`<span class="byte"><b>${hexByte(byte)}</b><i>${i}</i></span>`)}
        <span class="muted ascii" title="As characters">${String.fromCharCode(...Array.from(frame.data, (byte) => (byte > 31 && byte < 127 ? byte : 0xb7)))}</span>
      </div>
      <div class="frame-actions">
        <button class="small" title=${`Put ${text} on the send line`} @click=${() => (state.draft.value = { text })}>${icons.send} To send line</button>
        <button class="icon-button" aria-label="Close the frame" @click=${() => (state.chosenFrame.value = null)}>${icons.close}</button>
      </div>
    </div>`;
  }
}

customElements.define('od-frame-detail', FrameDetail);
