// What a PDO carries, and the frames that change it: shown before they are sent, and what
// the device said to each.

import { html, nothing, type PropertyValues } from 'lit';
import { effect } from '@preact/signals-core';
import type { ObjectRecord } from '../sim/api';
import { setFilter } from '../capture';
import { communication, frameOf, isMapping, isTransmit, MOST_BITS, stepsTo, unpackMapped, type Mapped, type Step } from '../can/mapping';
import { hexBytes } from '../format';
import { address, hexIndex } from '../format';
import { silence, transfer } from '../sim/client';
import { describe, readNow } from '../sim/link';
import { FRAME_BYTES, pack } from '../sim/packed';
import { abortWords } from '../sim/words-of-sdo';
import * as state from '../state';
import { T } from '../texts';
import { icons } from './icons';
import { View } from './view';

type Said = { tone: 'good' | 'error' | 'busy'; text: string };

/** An abort that a PDO causes which is on (CiA 301, table 22): it cannot be changed now. */
const WHILE_VALID = new Set([0x0601_0000, 0x0601_0002, 0x0609_0030, 0x0800_0020, 0x0800_0022]);

class Mapping extends View {
  static override properties = {
    pdo: { state: true }, entries: { state: true }, cobId: { state: true }, isOff: { state: true }, words: { state: true }, said: { state: true }, isBusy: { state: true }, hint: { state: true },
  };
  declare pdo: number;
  declare entries: Mapped[];
  declare cobId: number | null;
  /** The PDO is switched off meanwhile. */
  declare isOff: boolean;
  declare words: string[];
  declare said: Said[];
  declare isBusy: boolean;
  declare hint: string;
  private unopen: (() => void) | undefined;
  private asked = '';

  constructor() {
    super();
    this.pdo = 0;
    this.entries = [];
    this.cobId = null;
    this.isOff = false;
    this.words = [];
    this.said = [];
    this.isBusy = false;
    this.hint = '';
  }

  protected override firstUpdated(changed: PropertyValues): void {
    super.firstUpdated(changed);
    const dialog = this.querySelector('dialog')!;
    this.unopen = effect(() => {
      const wanted = state.mappingDialog.value;
      if (wanted !== null && !dialog.open) {
        dialog.showModal();
        const mappings = this.mappings();
        void this.load(mappings.some((one) => one.index === wanted) ? wanted : (mappings[0]?.index ?? 0));
      } else if (wanted === null && dialog.open) {
        dialog.close();
      }
    });
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.unopen?.();
  }

  /** The mappings of the device, transmit PDOs first. */
  private mappings(): ObjectRecord[] {
    const all = (state.device.value?.objects ?? []).filter(({ index, sub }) => sub === 0 && isMapping(index));
    return [...all.filter(({ index }) => isTransmit(index)), ...all.filter(({ index }) => !isTransmit(index))];
  }

  /** How many entries there is room for. */
  private room(): number {
    return (state.device.value?.objects ?? []).filter(({ index, sub }) => index === this.pdo && sub > 0 && sub <= MOST_BITS).length;
  }

  /** What this PDO may carry. */
  private candidates(): ObjectRecord[] {
    const fits = isTransmit(this.pdo) ? /^(ro|const|rw|rwr)$/ : /^(wo|rw|rww)$/;
    return (state.device.value?.objects ?? []).filter(({ mappable, access, bits }) => mappable && fits.test(access) && bits > 0 && bits <= MOST_BITS);
  }

  private async load(pdo: number): Promise<void> {
    this.pdo = pdo;
    this.said = [];
    this.hint = '';
    const room = this.room();
    const addresses = Array.from({ length: room + 1 }, (_, sub) => ({ index: pdo, sub }));
    const [cobId, count, ...entries] = await readNow([{ index: communication(pdo), sub: 1 }, ...addresses]);
    const number = (value: unknown): number => (typeof value === 'number' ? value : 0);
    this.cobId = typeof cobId === 'number' ? cobId : null;
    this.entries = entries.slice(0, number(count)).map((value) => unpackMapped(number(value)));
  }

  private change(entries: Mapped[]): void {
    this.entries = entries;
    this.said = [];
    this.hint = '';
  }

  private move(at: number, by: number): void {
    const entries = [...this.entries];
    const [entry] = entries.splice(at, 1);
    if (entry) entries.splice(at + by, 0, entry);
    this.change(entries);
  }

  private add(event: Event): void {
    const field = event.target as HTMLSelectElement;
    const object = state.objectsByKey.value.get(Number(field.value));
    field.value = '';
    if (object) this.change([...this.entries, { index: object.index, sub: object.sub, bits: object.bits }]);
  }

  private get steps(): Step[] {
    return stepsTo(this.pdo, this.entries, this.isOff ? this.cobId : null);
  }

  /** The frames in words, asked for when they change. */
  private ask(steps: Step[]): void {
    const node = state.nodeId.value;
    const frames = steps.map((step) => pack({ time: 0, id: 0x600 + node, extended: false, remote: false, fromPage: true, data: frameOf(step) }));
    const all = new Uint8Array(frames.length * FRAME_BYTES);
    frames.forEach((frame, i) => all.set(frame, i * FRAME_BYTES));
    const key = all.join();
    if (key === this.asked) return;
    this.asked = key;
    void describe(all).then((words) => {
      if (key === this.asked) this.words = words.map((text) => text.replace(/^SDO node \d+: /i, ''));
    });
  }

  private async send(): Promise<void> {
    this.isBusy = true;
    this.hint = '';
    this.said = [];
    for (const { index, sub, bytes } of this.steps) {
      const sofar = this.said;
      this.said = [...sofar, { tone: 'busy', text: state.running.value ? T.mapping.waiting : T.sdo.standing }];
      const outcome = await transfer({ index, sub, bytes });
      if (outcome.kind === 'written') {
        this.said = [...sofar, { tone: 'good', text: T.mapping.taken }];
        continue;
      }
      const text = outcome.kind === 'aborted' ? await abortWords(index, sub, outcome.code) : silence();
      this.said = [...sofar, { tone: 'error', text }];
      if (outcome.kind === 'aborted' && !this.isOff && this.cobId !== null && WHILE_VALID.has(outcome.code)) this.hint = T.mapping.tryOff;
      break;
    }
    this.isBusy = false;
  }

  private close(): void {
    state.mappingDialog.value = null;
  }

  private showFrames(): void {
    setFilter(`node:${state.nodeId.value} (object:${hexIndex(this.pdo).slice(0, 4)} or object:${hexIndex(communication(this.pdo)).slice(0, 4)})`);
    state.tab.value = 'console';
    this.close();
  }

  protected override render() {
    const t = T.mapping;
    const mappings = this.mappings();
    return html`<dialog class="dialog mapping" aria-labelledby="mapping-title" @close=${() => this.close()}
      @click=${(event: Event) => { if (event.target === event.currentTarget) this.close(); }}>
      <div class="dialog-body">
        <header class="dialog-head">
          <h2 id="mapping-title">${t.title}</h2>
          <button class="icon-button" aria-label=${T.close} @click=${() => this.close()}>${icons.close}</button>
        </header>
        ${mappings.length === 0 ? html`<p class="empty">${t.none}</p>` : this.editor(mappings)}
      </div>
    </dialog>`;
  }

  private editor(mappings: ObjectRecord[]) {
    const t = T.mapping;
    const bits = this.entries.reduce((sum, one) => sum + one.bits, 0);
    const candidates = this.candidates();
    const isFull = this.entries.length >= this.room();
    const steps = this.steps;
    this.ask(steps);
    return html`
      <div class="mapping-pdo">
        <label for="mapping-pdo">${t.pdo}</label>
        <select id="mapping-pdo" ?disabled=${this.isBusy} @change=${(event: Event) => this.load(Number((event.target as HTMLSelectElement).value))}>
          ${mappings.map((one) => html`<option value=${one.index} ?selected=${one.index === this.pdo}>${t.name(isTransmit(one.index), (one.index & 0x1ff) + 1)} · ${hexIndex(one.index)}</option>`)}
        </select>
        <span class="muted num">${this.cobId === null ? '' : t.cobId((this.cobId & 0x1fff_ffff).toString(16).toUpperCase(), this.cobId < 0x8000_0000)}</span>
      </div>
      ${mappings.find((one) => one.index === this.pdo)?.access.startsWith('rw') === false ? html`<p class="note mapping-fixed">${t.fixed}</p>` : nothing}
      <ol class="mapping-entries" aria-label=${t.entries}>
        ${this.entries.map((entry, i) => {
          const name = state.objectsByKey.value.get(state.keyOf(entry.index, entry.sub))?.name ?? t.unknown;
          return html`<li>
            <span class="num">${address(entry.index, entry.sub)}</span><span class="name">${name}</span><span class="muted num">${t.bits(entry.bits)}</span>
            <button class="icon-button" aria-label=${t.up(name)} title=${t.up(name)} ?disabled=${i === 0 || this.isBusy} @click=${() => this.move(i, -1)}>${icons.up}</button>
            <button class="icon-button" aria-label=${t.down(name)} title=${t.down(name)} ?disabled=${i === this.entries.length - 1 || this.isBusy} @click=${() => this.move(i, 1)}>${icons.down}</button>
            <button class="icon-button" aria-label=${t.remove(name)} title=${t.remove(name)} ?disabled=${this.isBusy} @click=${() => this.change(this.entries.filter((_, at) => at !== i))}>${icons.close}</button>
          </li>`;
        })}
        ${this.entries.length === 0 ? html`<li class="muted">${t.empty}</li>` : nothing}
      </ol>
      <div class="mapping-add">
        <select aria-label=${t.add} ?disabled=${isFull || this.isBusy} @change=${(event: Event) => this.add(event)}>
          <option value="">${isFull ? t.full : t.add}</option>
          ${candidates.map((one) => html`<option value=${state.keyOf(one.index, one.sub)}>${address(one.index, one.sub)} ${one.name} (${t.bits(one.bits)})</option>`)}
        </select>
        <meter min="0" max=${MOST_BITS} .value=${Math.min(bits, MOST_BITS)} aria-label=${t.size}></meter>
        <span class="num note" data-tone=${bits > MOST_BITS ? 'error' : ''}>${t.sum(bits, MOST_BITS)}</span>
      </div>
      ${this.cobId === null
        ? nothing
        : html`<label class="choice"><input type="checkbox" .checked=${this.isOff} ?disabled=${this.isBusy} @change=${(event: Event) => { this.isOff = (event.target as HTMLInputElement).checked; this.said = []; }}>
            <span>${t.off}<span class="muted">${t.offHint}</span></span></label>`}
      <section aria-label=${t.frames}>
        <h3 class="mapping-head">${t.frames}</h3>
        <ol class="mapping-steps">${steps.map((step, i) => this.step(step, i, steps))}</ol>
      </section>
      ${this.hint ? html`<p class="note" data-tone="error" role="status">${this.hint}</p>` : nothing}
      <div class="dialog-foot">
        <button ?disabled=${this.isBusy} @click=${() => this.load(this.pdo)}>${t.reload}</button>
        <button @click=${() => this.showFrames()}>${icons.console} ${T.objects.frames}</button>
        <div class="spacer"></div>
        <button class="primary" ?disabled=${this.isBusy || this.pdo === 0} @click=${() => this.send()}>${icons.send} ${t.send(steps.length)}</button>
      </div>`;
  }

  private step(step: Step, i: number, steps: Step[]) {
    const said = this.said[i];
    const isFirst = steps[i - 1]?.kind !== step.kind;
    return html`<li data-tone=${said?.tone ?? ''}>
      ${isFirst ? html`<strong>${T.mapping.step[step.kind]}</strong>` : nothing}
      <code class="num">${(0x600 + state.nodeId.value).toString(16).toUpperCase()} <span>${hexBytes(frameOf(step))}</span></code>
      <span class="said">${said && said.tone !== 'busy' ? html`<b>${said.tone === 'good' ? '✓' : '✗'}</b> ${said.text}` : said ? said.text : html`<span class="muted">${this.words[i] ?? ''}</span>`}</span>
    </li>`;
  }
}

customElements.define('od-mapping', Mapping);
