// The hardware controls of a device beside its shaft: switches, faults, its CAN
// controller, and the shared bus line.

import { html, nothing } from 'lit';
import * as state from '../state';
import type { LineStatus, Status } from '../sim/api';
import { sendLine } from '../actions';
import { act } from '../sim/link';
import { T } from '../texts';
import { icons } from './icons';
import { View } from './view';

const RATES = [10, 20, 50, 100, 125, 250, 500, 800, 1000];

/** Bit rates of the DIP switches in kbit/s, by their number (manual 000, 7.2.2). */
const DIP_RATES = [10, 20, 50, 125, 250, 500, 800, 1000];

/** Returns whether the switches differ from the values in use. */
export const waitsFor = (status: Status): boolean =>
  status.powered && status.shaft !== null && status.nodeSwitch !== 0 && (status.nodeSwitch !== status.nodeId || (status.rate !== null && DIP_RATES[status.rateSwitch] !== status.rate));

class Hardware extends View {
  protected override render() {
    const status = state.status.value;
    const line = state.line.value;
    if (!status || !line) return nothing;
    return html`<div class="hardware scroll">${this.switches(status)}${this.faults(status)}${this.controller(status)}${this.wire(line)}</div>`;
  }

  private switches(status: Status) {
    if (!status.shaft) return nothing;
    const node = state.selectedNode.value;
    const waits = status.powered && status.nodeSwitch !== 0 && status.nodeSwitch !== status.nodeId;
    const isAtZero = status.nodeSwitch === 0;
    return html`<section class="hw-row">
      <label for="node-switch" title=${T.hardware.nodeSwitchHint}>${T.hardware.nodeSwitch}</label>
      <span class="hw-value">
        <input id="node-switch" class="num" type="number" min="0" max="99" title=${T.hardware.nodeSwitchHint} .value=${String(status.nodeSwitch)}
          @change=${(event: Event) => act({ op: 'switches', node, id: Math.max(0, Math.min(99, Math.trunc(Number((event.target as HTMLInputElement).value)) || 0)) })}>
        ${waits ? html`<span class="pill" data-tone="amber">${T.hardware.atReset}</span>` : nothing}
      </span>
      <span id="rate-switch" title=${T.hardware.rateSwitchHint}>${T.hardware.rateSwitch}</span>
      <span class="hw-value" role="group" aria-labelledby="rate-switch">
        ${[4, 2, 1].map((bit, i) => html`<button class="dip" role="switch" aria-checked=${(status.rateSwitch & bit) !== 0} aria-label=${`DIP ${i + 1}`} title=${`DIP ${i + 1}`}
          @click=${() => act({ op: 'switches', node, dip: { bit, on: (status.rateSwitch & bit) === 0 } })}><span></span></button>`)}
        <span class="num muted" aria-label=${T.hardware.activeRate}>${T.hardware.kbit(status.rate)}</span>
      </span>
      ${isAtZero
        ? html`<p class="note hw-note">${T.hardware.atZero}</p>`
        : waitsFor(status)
          ? html`<p class="note hw-note">${T.hardware.waits} <button class="small" @click=${() => sendLine('nmt reset')}>${T.hardware.startNow}</button></p>`
          : nothing}
    </section>`;
  }

  private faults(status: Status) {
    if (status.canBreak.length === 0) return nothing;
    const node = state.selectedNode.value;
    return html`<section>
      <h3>${T.hardware.faults}</h3>
      <div class="chips">${status.canBreak.map((name) => {
        const isOn = status.faults.includes(name);
        return html`<button class="small chip" aria-pressed=${isOn} @click=${() => act({ op: 'fault', node, name, on: !isOn })}>${T.hardware.fault[name] ?? name}</button>`;
      })}</div>
    </section>`;
  }

  private controller(status: Status) {
    const station = state.selectedNode.value + 1;
    return html`<section>
      <h3>${T.hardware.node}</h3>
      ${counters('node', status, station)}
      <od-bus-off .node=${station - 1}></od-bus-off>
    </section>`;
  }

  private wire(line: LineStatus) {
    const set = (change: Partial<{ real: boolean; terminators: number; rate: number | null }>): void =>
      act({ op: 'line', real: line.real, terminators: line.terminators, rate: line.fixedRate, ...change });
    return html`<section>
      <h3>${T.hardware.line}</h3>
      <div class="hw-row">
        <span title=${T.hardware.realHint}>${T.hardware.real}</span>
        <span class="hw-value"><button class="switch" role="switch" aria-checked=${line.real} aria-label=${T.hardware.real} title=${T.hardware.realHint} @click=${() => set({ real: !line.real })}><span class="switch-track"><span class="switch-thumb"></span></span></button></span>
        <span id="terminators">${T.hardware.terminators}</span>
        <span class="hw-value segmented" role="group" aria-labelledby="terminators">${[0, 1, 2].map((count) => html`<button class="small" aria-pressed=${line.terminators === count} aria-label=${`${count} × 120 Ω`} @click=${() => set({ terminators: count, real: true })}>${count}</button>`)}</span>
        <label for="page-rate">${T.hardware.pageRate}</label>
        <span class="hw-value"><span class="select bordered"><select id="page-rate" @change=${(event: Event) => set({ rate: Number((event.target as HTMLSelectElement).value) || null, real: true })}>
          <option value="0" ?selected=${line.fixedRate === null}>${T.hardware.auto}${line.rate ? ` (${line.rate})` : ''}</option>
          ${RATES.map((rate) => html`<option value=${rate} ?selected=${line.fixedRate === rate}>${rate} kbit/s</option>`)}
        </select>${icons.chevron}</span></span>
      </div>
      <h3>${T.hardware.page}</h3>
      ${counters('page', line, 0)}
      <od-bus-off></od-bus-off>
    </section>`;
  }
}

/** A controller: its state, its counters, and whether it is connected. */
function counters(key: string, one: Pick<Status, 'controller' | 'transmitErrors' | 'receiveErrors' | 'plugged'>, station: number) {
  const tone = one.controller === 'bus-off' ? 'bad' : one.controller === 'error passive' ? 'amber' : 'good';
  return html`<div class="controller" data-controller=${key}>
    <span class="pill" data-tone=${tone}>${one.controller}</span>
    <span class="num muted">${T.hardware.counters(one.transmitErrors, one.receiveErrors)}</span>
    <span class="spacer"></span>
    ${one.controller === 'error active' ? nothing : html`<button class="small" @click=${() => act({ op: 'restart', station })}>${T.hardware.restart}</button>`}
    <label class="check"><input type="checkbox" .checked=${one.plugged} @change=${(event: Event) => act({ op: 'plug', station, on: (event.target as HTMLInputElement).checked })}> ${T.hardware.plugged}</label>
  </div>`;
}

customElements.define('od-hardware', Hardware);
