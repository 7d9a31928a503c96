// The saved data of a device: the bytes, objects that are not saved, and a power cut
// during a save.

import { html, nothing } from 'lit';
import * as state from '../state';
import { hexByte } from '../format';
import { address } from '../format';
import { act, send } from '../sim/link';
import { T } from '../texts';
import { View } from './view';

const WIDTH = 16;

class EepromView extends View {
  static override properties = { bytesLeft: { state: true }, isArmed: { state: true } };
  declare bytesLeft: string;
  declare isArmed: boolean;

  constructor() {
    super();
    this.bytesLeft = '20';
    this.isArmed = false;
  }

  override connectedCallback(): void {
    super.connectedCallback();
    send({ op: 'look', eeprom: true });
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    send({ op: 'look', eeprom: false });
    state.eeprom.value = null;
  }

  private cut(): void {
    const bytes = Math.max(0, Math.trunc(Number(this.bytesLeft)) || 0);
    act({ op: 'cut', node: state.selectedNode.value, bytes });
    this.isArmed = true;
  }

  private cycle(): void {
    const node = state.selectedNode.value;
    act({ op: 'power', node, on: false });
    act({ op: 'power', node, on: true });
    this.isArmed = false;
  }

  protected override render() {
    const bytes = state.eeprom.value;
    if (!bytes) return nothing;
    if (bytes.length === 0) return html`<p class="empty">${T.eeprom.none}</p>`;
    const unsaved = [...state.unsaved.value];
    const used = bytes.reduce((count, byte) => count + Number(byte !== 0xff), 0);
    if (!state.powered.value) this.isArmed = false;
    return html`<div class="eeprom">
      <p>${T.eeprom.unsaved(unsaved.length)}</p>
      ${unsaved.length
        ? html`<ul class="unsaved scroll">${unsaved.slice(0, 40).map((key) => {
            const object = state.objectsByKey.value.get(key);
            return html`<li><span class="num">${address(key >> 8, key & 255)}</span> ${object?.name ?? ''}</li>`;
          })}</ul>`
        : nothing}
      <div class="eeprom-actions">
        <button class="small" @click=${() => this.cycle()}>${T.eeprom.cycle}</button>
        <button class="small" aria-pressed=${this.isArmed} title=${this.isArmed ? T.eeprom.armed : ''} @click=${() => this.cut()}>${T.eeprom.cut}</button>
        <label>${T.eeprom.cutAt} <input class="num" type="number" min="0" max=${bytes.length} .value=${this.bytesLeft} @input=${(event: Event) => (this.bytesLeft = (event.target as HTMLInputElement).value)}></label>
      </div>
      <p class="muted num">${T.eeprom.bytes(used, bytes.length)}</p>
      <pre class="hex scroll" tabindex="0" role="region" aria-label=${T.eeprom.view}>${Array.from({ length: Math.ceil(bytes.length / WIDTH) }, (_, line) => this.line(bytes, line * WIDTH))}</pre>
    </div>`;
  }

  private line(bytes: Uint8Array, from: number) {
    const part = bytes.subarray(from, from + WIDTH);
    if (from && part.every((byte) => byte === 0xff) && bytes.subarray(from - WIDTH, from).every((byte) => byte === 0xff)) return nothing;
    const ascii = Array.from(part, (byte) => (byte > 31 && byte < 127 ? String.fromCharCode(byte) : '·')).join('');
    return html`<span class="muted">${from.toString(16).toUpperCase().padStart(4, '0')}</span>  ${Array.from(part, (byte) => (byte === 0xff ? html`<i>FF </i>` : `${hexByte(byte)} `))} <span class="muted">${ascii}</span>${'\n'}`;
  }
}

customElements.define('od-eeprom', EepromView);
