// From the sensor to the PDO, step by step.

import { html, nothing } from 'lit';
import * as state from '../state';
import { grouped, hexByte } from '../format';
import { T } from '../texts';
import { View } from './view';

class Chain extends View {
  protected override render() {
    const shaft = state.shaft.value;
    const chain = state.chain.value;
    const pdo = state.lastPdo.value;
    const isLive = state.powered.value;
    const t = T.encoder.chain;
    const how = chain?.reversed == null ? [] : [chain.reversed ? t.backwards : t.forwards, chain.perTurn ? t.perTurn(grouped(chain.perTurn)) : t.unscaled];
    return html`<div class="chain" aria-label=${t.title} role="group">
      <div class="chain-step">
        <span class="chain-name">${t.sensor}</span>
        <span class="chain-value num" aria-label=${t.raw}>${shaft ? grouped(shaft.raw) : '–'}</span>
        <span class="chain-note">${t.rawSteps}</span>
      </div>
      <span class="chain-arrow" aria-hidden="true"></span>
      <div class="chain-step">
        <span class="chain-name">6004h</span>
        <span class="chain-value num" aria-label=${t.position}>${isLive && chain?.position != null ? grouped(chain.position) : '–'}</span>
        <span class="chain-note" title=${how.join(', ')}>${how.at(-1) ?? nothing}</span>
      </div>
      <span class="chain-arrow" aria-hidden="true"></span>
      <div class="chain-step">
        <span class="chain-name">PDO1</span>
        <span class="chain-value num bytes" aria-label=${t.pdo}>${pdo ? Array.from(pdo.data, (byte) => html`<span>${hexByte(byte)}</span>`) : html`<span>–</span>`}</span>
        <span class="chain-note">${pdo ? t.lowFirst : t.whenOperational}</span>
      </div>
    </div>`;
  }
}

customElements.define('od-chain', Chain);
