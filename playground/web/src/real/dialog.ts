// The dialog that connects to a real bus and shows the state of the connection.

import { html, nothing, type PropertyValues } from 'lit';
import { effect } from '@preact/signals-core';
import { sheet } from '../sheet';
import * as state from '../state';
import { T } from '../texts';
import { R } from './texts';
import { icons } from '../views/icons';
import { View } from '../views/view';
import type { RealState } from './api';
import { again, connectAdapter, connectTo, hasSerial, isConnecting, last, leave, problem, setSending } from './connect';
import './mark';
import './panel';

/** Bit rates of slcan in kbit/s; 0: that of the adapter. */
const RATES = [0, 10, 20, 50, 100, 125, 250, 500, 800, 1000];
const BAUDS = [9600, 57_600, 115_200, 230_400, 460_800, 500_000, 921_600, 1_000_000, 2_000_000, 3_000_000];

class Connect extends View {
  static override properties = { address: { state: true }, rate: { state: true }, baud: { state: true }, along: { state: true } };
  declare address: string;
  declare rate: number;
  declare baud: number;
  declare along: boolean;
  private unopen: (() => void) | undefined;

  constructor() {
    super();
    Object.assign(this, last());
  }

  protected override firstUpdated(changed: PropertyValues): void {
    super.firstUpdated(changed);
    const dialog = this.querySelector('dialog')!;
    this.unopen = effect(() => {
      if (state.realDialog.value && !dialog.open) void Promise.all([sheet('dialogs'), sheet('real')]).then(() => state.realDialog.peek() && !dialog.open && dialog.showModal());
      else if (!state.realDialog.value && dialog.open) dialog.close();
    });
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.unopen?.();
  }

  private close(): void {
    if (isConnecting.peek()) leave();
    problem.value = '';
    state.realDialog.value = false;
  }

  /** Opens the bus in the address of the page. */
  async go(address: string): Promise<void> {
    this.address = address;
    state.realDialog.value = true;
    await this.dial();
  }

  private async dial(): Promise<void> {
    if (await connectTo(this.address, this.along)) state.realDialog.value = false;
  }

  private async plug(): Promise<void> {
    if (await connectAdapter(this.rate, this.baud, this.along)) state.realDialog.value = false;
  }

  private form() {
    const isBusy = isConnecting.value;
    const value = (event: Event): string => (event.target as HTMLInputElement).value;
    return html`<p>${R.what}</p>
      <form class="real-part" @submit=${(event: Event) => { event.preventDefault(); void this.dial(); }}>
        <h3>${R.webSocket}</h3>
        <div class="real-row">
          <input class="num grow" aria-label=${R.address} placeholder="ws://127.0.0.1:29538/?token=…" autocomplete="off" autocapitalize="off" spellcheck="false" .value=${this.address} @input=${(event: Event) => (this.address = value(event))}>
          <button class="primary" ?disabled=${isBusy}>${isBusy ? R.connecting : R.connect}</button>
        </div>
        <p class="note">${R.addressHint}</p>
      </form>
      <section class="real-part">
        <h3>${R.serial}</h3>
        ${hasSerial()
          ? html`<div class="real-row">
              <label>${R.rate} <span class="select bordered"><select aria-label=${R.rate} @change=${(event: Event) => (this.rate = Number(value(event)))}>
                ${RATES.map((rate) => html`<option value=${rate} ?selected=${rate === this.rate}>${rate ? R.kbit(rate) : R.keepRate}</option>`)}</select>${icons.chevron}</span></label>
              <label>${R.baud} <span class="select bordered"><select aria-label=${R.baud} @change=${(event: Event) => (this.baud = Number(value(event)))}>
                ${BAUDS.map((baud) => html`<option value=${baud} ?selected=${baud === this.baud}>${R.baudOf(baud)}</option>`)}</select>${icons.chevron}</span></label>
              <button ?disabled=${isBusy} @click=${() => this.plug()}>${R.choose}</button>
            </div>
            <p class="note">${R.serialHint}</p>`
          : html`<p class="note">${R.noSerial}</p>`}
      </section>
      <label class="check"><input type="checkbox" .checked=${this.along} @change=${(event: Event) => (this.along = (event.target as HTMLInputElement).checked)}> ${R.along}</label>
      ${this.along ? html`<p class="note">${R.alongHint}</p>` : nothing}
      <p class="note real-problem" data-tone="error" role="alert">${problem.value}</p>`;
  }

  private link(real: RealState) {
    const isLost = real.status === 'lost';
    const counts = [
      R.came(real.frames),
      ...(real.held ? [R.heldBack(real.held)] : []),
      ...(real.dropped ? [R.dropped(real.dropped)] : []),
      ...(real.unsent ? [R.unsent(real.unsent)] : []),
      ...(real.refused ? [R.refused(real.refused)] : []),
      ...(real.noise ? [R.noise(real.noise)] : []),
    ];
    return html`<p class="real-place"><span class="real-mark" data-status=${real.status}><i></i><strong>${R.mark}</strong></span> <span class="num">${real.name}</span></p>
      ${isLost ? html`<p role="alert" class="bad">${real.why ? R.why(real.why, real.name, real.kind === 'serial') : R.lost} ${real.kind === 'ws' ? R.retries : R.replug}</p>` : nothing}
      <label class="check"><input type="checkbox" .checked=${real.sending} ?disabled=${isLost} @change=${(event: Event) => setSending((event.target as HTMLInputElement).checked)}> ${real.sending ? R.on : R.off}.</label>
      ${state.status.value?.real === false ? html`<od-real-nodes></od-real-nodes>` : nothing}
      <ul class="real-counts num">${counts.map((text) => html`<li>${text}</li>`)}</ul>
      <div class="dialog-foot">
        <button @click=${() => { leave(); this.close(); }}>${R.back}</button>
        <span class="spacer"></span>
        ${isLost ? html`<button class="primary" @click=${() => void again()}>${R.again}</button>` : nothing}
      </div>`;
  }

  protected override render() {
    const real = state.real.value;
    return html`<dialog class="dialog" aria-labelledby="connect-title" @close=${() => this.close()} @click=${(event: Event) => event.target === event.currentTarget && this.close()}>
      <div class="dialog-body">
        <header class="dialog-head">
          <h2 id="connect-title">${real ? R.connected : R.title}</h2>
          <button class="icon-button" aria-label=${T.close} @click=${() => this.close()}>${icons.close}</button>
        </header>
        ${real ? this.link(real) : this.form()}
      </div>
    </dialog>`;
  }
}

customElements.define('od-connect', Connect);
export type { Connect };
