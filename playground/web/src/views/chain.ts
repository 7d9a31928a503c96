// From the sensor to the telegram, step by step.

import { html, nothing } from 'lit';
import * as state from '../state';
import { hexByte } from '../format';
import { grouped } from '../format';
import { T } from '../texts';
import { View } from './view';


/** Bits of 6000h. */
const REVERSED = 1;
const SCALING = 4;

class Chain extends View {
  protected override render() {
    const shaft = state.shaft.value;
    const values = state.chain.value ?? [];
    const [parameters, perTurn, , position] = values.map((value) => (typeof value === 'number' ? value : null));
    const pdo = state.lastPdo.value;
    const isLive = state.powered.value;
    const how: string[] = [];
    if (parameters != null) {
      how.push(parameters & REVERSED ? T.encoder.chain.backwards : T.encoder.chain.forwards);
      how.push(parameters & SCALING && perTurn ? T.encoder.chain.perTurn(grouped(perTurn)) : T.encoder.chain.unscaled);
    }
    return html`<div class="chain" aria-label=${T.encoder.chain.title} role="group">
      <div class="chain-step">
        <span class="chain-name">${T.encoder.chain.sensor}</span>
        <span class="chain-value num" aria-label=${T.encoder.chain.raw}>${shaft ? grouped(shaft.raw) : '–'}</span>
        <span class="chain-note">${T.encoder.chain.rawSteps}</span>
      </div>
      <span class="chain-arrow" aria-hidden="true"></span>
      <div class="chain-step">
        <span class="chain-name">6004h</span>
        <span class="chain-value num" aria-label=${T.encoder.chain.position}>${isLive && position != null ? grouped(position) : '–'}</span>
        <span class="chain-note" title=${how.join(', ')}>${how.at(-1) ?? nothing}</span>
      </div>
      <span class="chain-arrow" aria-hidden="true"></span>
      <div class="chain-step">
        <span class="chain-name">PDO1</span>
        <span class="chain-value num bytes" aria-label=${T.encoder.chain.pdo}>${pdo ? Array.from(pdo.data, (byte) => html`<span>${hexByte(byte)}</span>`) : html`<span>–</span>`}</span>
        <span class="chain-note">${pdo ? T.encoder.chain.lowFirst : T.encoder.chain.whenOperational}</span>
      </div>
    </div>`;
  }
}

customElements.define('od-chain', Chain);
