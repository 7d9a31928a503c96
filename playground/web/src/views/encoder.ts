// The encoder: shaft, power, state, LEDs, and the steps from angle to PDO.

import { html, nothing, type TemplateResult } from 'lit';
import { effect } from '@preact/signals-core';
import * as state from '../state';
import { sendLine, setPower, setRpm, turnTo } from '../actions';
import type { Lamp } from '../sim/api';
import { grouped } from '../format';
import { T } from '../texts';
import { choose, motionOf, parseMotion, PROFILES } from './motion';
import { icons } from './icons';
import { load, View } from './view';
import './shaft';
import './chain';
import { waitsFor } from './hardware';

const FASTEST = 6000;

/** The device profile: the low 16 bits of 1000h. */
function profile(): number {
  const type = state.objectsByKey.value.get(state.keyOf(0x1000, 0))?.default;
  return typeof type === 'number' || typeof type === 'bigint' ? Number(BigInt(type) & 0xffffn) : 406;
}

type Part = keyof typeof T.encoder.tabs;

/** Kind of the selected device, by its profile. */
export const deviceWord = (): string => T.encoder.titles[profile()] ?? T.encoder.title;

class Encoder extends View {
  static override properties = { shown: { state: true }, own: { state: true } };
  declare shown: Part;
  /** The text for a custom profile; null while another profile is selected. */
  declare own: string | null;

  private unfollow: (() => void) | undefined;

  constructor() {
    super();
    this.shown = 'shaft';
    this.own = null;
  }

  override connectedCallback(): void {
    super.connectedCallback();
    // A lesson begins with the shaft: another view may show the fault that is to be found.
    this.unfollow = effect(() => {
      void state.lessonRun.value;
      this.shown = 'shaft';
      this.own = null;
    });
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.unfollow?.();
  }

  protected override render() {
    const isOn = state.powered.value;
    const nmtState = state.nmt.value;
    const hasShaft = state.shaft.value !== null || state.device.value === null;
    return html`
      <header class="panel-head">
        ${state.isBeside.value ? html`<button class="icon-button fold-button" aria-expanded=${state.encoderOpen.value} aria-label=${T.encoder.fold} title=${T.encoder.fold} @click=${() => (state.encoderOpen.value = !state.encoderOpen.value)}>${icons.chevron}</button>` : nothing}
        <h2>${deviceWord()}</h2>
        <span class="pill" data-nmt=${nmtState} role="status" aria-label=${T.encoder.nmt}>${T.encoder.states[nmtState]}</span>
        <div class="spacer"></div>
        <button class="small" aria-label=${T.encoder.resetLabel} title=${T.encoder.resetTitle} ?disabled=${!isOn} @click=${() => sendLine('nmt reset')}>${icons.reset} ${T.encoder.reset}</button>
        <button class="switch" role="switch" aria-checked=${isOn} aria-label=${T.encoder.power} title=${isOn ? T.encoder.powerOff : T.encoder.powerOn} @click=${() => setPower(!isOn)}>
          ${icons.power}<span class="switch-track"><span class="switch-thumb"></span></span>
        </button>
      </header>
      <div class="parts" role="group" aria-label=${T.encoder.tabsLabel}>
        ${(Object.keys(T.encoder.tabs) as Part[]).map((part) => html`<button class="small" aria-pressed=${part === this.shown} @click=${() => this.show(part)}>${hasShaft || part !== 'shaft' ? T.encoder.tabs[part] : deviceWord()}${part === 'eeprom' && state.unsaved.value.size ? html`<span class="count-badge" title=${T.eeprom.unsaved(state.unsaved.value.size)}>${state.unsaved.value.size}</span>` : nothing}${part === 'hardware' && this.waits() ? html`<span class="count-badge" title=${T.hardware.waitsTitle}>!</span>` : part === 'hardware' && this.isOdd() ? html`<span class="alert-dot"></span>` : nothing}</button>`)}
      </div>
      ${this.shown === 'hardware' ? html`<od-hardware></od-hardware>` : this.shown === 'eeprom' ? html`<od-eeprom></od-eeprom>` : this.shaftPart(hasShaft)}
    `;
  }

  private show(part: Part): void {
    this.shown = part;
    if (part === 'eeprom') load(() => import('./eeprom'));
    state.encoderOpen.value = true;
  }

  private waits(): boolean {
    const status = state.status.value;
    return status !== null && waitsFor(status);
  }

  /** Whether the hardware page shows something unusual. */
  private isOdd(): boolean {
    const status = state.status.value;
    return status !== null && (status.faults.length > 0 || status.controller !== 'error active' || !status.plugged);
  }

  private shaftPart(hasShaft: boolean): TemplateResult {
    if (!hasShaft) return html`<od-machine></od-machine>`;
    return html`<div class="encoder-body">
        <od-shaft></od-shaft>
        <div class="readouts"><od-angle></od-angle>${this.rpm()}${this.motion()}<od-leds></od-leds></div>
      </div>
      <od-chain></od-chain>`;
  }

  private motion(): TemplateResult {
    const now = state.status.value?.moves ? motionOf(state.selectedNode.value) : '';
    const typed = this.own;
    const wrong = typed === null ? null : parseMotion(typed);
    return html`<div class="motion">
      <label class="field-label" for="motion">${T.encoder.profile}</label>
      <span class="select bordered"><select id="motion" @change=${(event: Event) => {
        const { value } = event.target as HTMLSelectElement;
        this.own = value === 'own' ? '' : null;
        if (value !== 'own') choose(state.selectedNode.value, value);
      }}>
        <option value="" ?selected=${now === '' && typed === null}>${T.encoder.steady}</option>
        ${PROFILES.map(({ key }) => html`<option value=${key} ?selected=${now === key}>${T.encoder.profiles[key]}</option>`)}
        <option value="own" ?selected=${typed !== null || now === 'own'}>${T.encoder.own}</option>
      </select>${icons.chevron}</span>
      ${typed === null
        ? nothing
        : html`<input class="num" aria-label=${T.encoder.own} placeholder="60 2, 0 1, -60 2" .value=${typed} aria-invalid=${typed !== '' && typeof wrong === 'string'}
            title=${T.encoder.ownHint} @input=${(event: Event) => (this.own = (event.target as HTMLInputElement).value)}
            @keydown=${(event: KeyboardEvent) => event.key === 'Enter' && choose(state.selectedNode.value, 'own', this.own ?? '')}>
          <p class="note" data-tone=${typed !== '' && typeof wrong === 'string' ? 'error' : ''}>${typed !== '' && typeof wrong === 'string' ? T.encoder.ownBad(wrong) : T.encoder.ownHint}</p>`}
    </div>`;
  }

  private rpm(): TemplateResult {
    const rpm = state.shaft.value?.rpm ?? 0;
    const set = (text: string): void => {
      const value = Number(text);
      if (Number.isFinite(value)) setRpm(Math.max(-FASTEST, Math.min(FASTEST, value)));
    };
    // The slider is fine around standstill, and coarse at its ends.
    const toSlider = (value: number): number => Math.sign(value) * Math.cbrt(Math.abs(value) / FASTEST) * 100;
    const fromSlider = (value: number): number => Math.round((Math.abs(value) < 6 ? 0 : (value / 100) ** 3) * FASTEST);
    return html`<div class="rpm">
      <label class="field-label" for="rpm">${T.encoder.speed}</label>
      <span class="input-unit"><input id="rpm" class="num" type="number" step="1" min=${-FASTEST} max=${FASTEST} .value=${String(Math.round(rpm * 100) / 100)}
        @change=${(event: Event) => set((event.target as HTMLInputElement).value)}><span>${T.encoder.rpm}</span></span>
      <input type="range" min="-100" max="100" step="1" aria-label=${T.encoder.slider} aria-valuetext=${`${Math.round(rpm)} ${T.encoder.rpm}`}
          .value=${String(toSlider(rpm))} @input=${(event: Event) => set(String(fromSlider(Number((event.target as HTMLInputElement).value))))}>
    </div>`;
  }
}

/** Revolutions and angle. */
class Angle extends View {
  protected override render() {
    const turns = state.shaft.value?.turns ?? 0;
    const whole = Math.floor(turns);
    const degrees = (turns - whole) * 360;
    return html`<div class="angle"><dl>
      <div><dt>${T.encoder.turn}</dt><dd class="num" aria-label=${T.encoder.turns}>${grouped(whole)}</dd></div>
      <div><dt>${T.encoder.angle}</dt><dd class="num" aria-label=${T.encoder.angle}>${degrees.toFixed(2)}°</dd></div></dl>
      <button class="small quiet" title=${T.encoder.toZeroTitle} @click=${() => turnTo(0)}>${T.encoder.toZero}</button>
    </div>`;
  }
}

/** The dual LED on the bus cover (manual 000, 7.3). */
class Lamps extends View {
  protected override render() {
    const { green, red } = state.status.value?.leds ?? { green: 'off', red: 'off' };
    // 200 ms on, 200 ms off, in virtual time unless that would be too fast to see.
    const isFast = state.running.value && state.speed.value > 2;
    const isLit = Math.floor(isFast ? performance.now() / 200 : state.now.value / 200_000) % 2 === 0;
    const shown = (lamp: Lamp): boolean => lamp === 'on' || (lamp === 'flashing' && isLit);
    return html`<div class="leds" role="img" aria-label=${T.encoder.lamp(this.words())}>
      <span class="led" data-colour="green" data-pattern=${green} data-lit=${shown(green)}></span>
      <span class="led" data-colour="red" data-pattern=${red} data-lit=${shown(red)}></span>
      <span class="led-words">${this.words()}</span>
    </div>`;
  }

  private words(): string {
    const { green, red } = state.status.value?.leds ?? { green: 'off', red: 'off' };
    if (red === 'on') return T.encoder.lamps.error;
    if (red === 'flashing') return T.encoder.lamps.warning;
    if (green === 'off') return T.encoder.lamps.dark;
    if (green === 'flashing') return T.encoder.lamps.preOperational;
    return state.nmt.value === 'stopped' ? T.encoder.lamps.stopped : T.encoder.lamps.operational;
  }
}

customElements.define('od-angle', Angle);
customElements.define('od-leds', Lamps);
customElements.define('od-encoder', Encoder);
