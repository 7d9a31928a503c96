// The content of a PDO, and the frames that change it: shown before they are sent, with
// the response of the device to each.

import { html, nothing, type PropertyValues } from 'lit';
import { effect } from '@preact/signals-core';
import type { Mapped, MappingStep, ObjectRecord, Pdo } from '../sim/api';
import { setFilter } from '../capture';
import { address, hexBytes, hexId, hexIndex } from '../format';
import { askBus } from '../sim/link';
import { failure, transfer } from '../sim/sdo';
import { sheet } from '../sheet';
import * as state from '../state';
import { T } from '../texts';
import { icons } from './icons';
import { D } from './texts';
import { View } from './view';

await sheet('dialogs');

type Message = { tone: 'good' | 'error' | 'busy'; text: string };

/** Maximum number of bits in a PDO. */
const MOST_BITS = 64;

class Mapping extends View {
  static override properties = {
    pdos: { state: true }, pdo: { state: true }, entries: { state: true }, isOff: { state: true }, steps: { state: true }, said: { state: true }, isBusy: { state: true }, hint: { state: true },
  };
  /** The PDOs of the device when they were read. */
  declare pdos: Pdo[];
  declare pdo: Pdo | null;
  declare entries: Mapped[];
  /** The PDO is disabled during the change. */
  declare isOff: boolean;
  declare steps: MappingStep[];
  declare said: Message[];
  declare isBusy: boolean;
  declare hint: string;
  private unopen: (() => void) | undefined;

  constructor() {
    super();
    this.pdos = [];
    this.pdo = null;
    this.entries = [];
    this.isOff = false;
    this.steps = [];
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
        void this.load(wanted);
      } else if (wanted === null && dialog.open) {
        dialog.close();
      }
    });
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.unopen?.();
  }

  /** The objects that this PDO may contain. */
  private candidates({ transmits }: Pdo): ObjectRecord[] {
    return (state.device.value?.objects ?? []).filter(({ fitsTpdo, fitsRpdo }) => (transmits ? fitsTpdo : fitsRpdo));
  }

  /** Reads the PDOs again, and shows the one with this mapping parameter, else the first. */
  private async load(mapping: number): Promise<void> {
    this.pdos = (await askBus('pdos', state.selectedNode.peek())) ?? [];
    this.pdo = this.pdos.find((one) => one.mapping === mapping) ?? this.pdos[0] ?? null;
    this.change(this.pdo?.entries ?? []);
  }

  private change(entries: Mapped[]): void {
    this.entries = entries;
    this.said = [];
    this.hint = '';
    void this.plan();
  }

  /** The frames that set these entries, with their texts. */
  private async plan(): Promise<void> {
    const { pdo, entries, isOff } = this;
    this.steps = [];
    const packed = Uint32Array.from(entries, ({ index, sub, bits }) => index * 0x1_0000 + sub * 256 + bits);
    const steps = pdo ? await askBus('mappingSteps', state.selectedNode.peek(), pdo.mapping, packed, isOff ? pdo.cobId?.raw : null) : [];
    if (entries === this.entries && isOff === this.isOff) this.steps = steps ?? [];
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

  private async send(): Promise<void> {
    this.isBusy = true;
    this.hint = '';
    this.said = [];
    for (const step of this.steps) {
      const sofar = this.said;
      this.said = [...sofar, { tone: 'busy', text: state.running.value ? D.mapping.waiting : T.sdo.paused }];
      const outcome = await transfer(step, step.bytes);
      if (outcome.kind === 'done') {
        this.said = [...sofar, { tone: 'good', text: D.mapping.taken }];
        continue;
      }
      this.said = [...sofar, { tone: 'error', text: failure(outcome) }];
      if (outcome.wantsPdoOff && !this.isOff && this.pdo?.cobId) this.hint = D.mapping.tryOff;
      break;
    }
    this.isBusy = false;
  }

  private close(): void {
    state.mappingDialog.value = null;
  }

  private showFrames({ mapping, parameter }: Pdo): void {
    setFilter(`node:${state.nodeId.value} (object:${hexIndex(mapping).slice(0, 4)} or object:${hexIndex(parameter).slice(0, 4)})`);
    state.tab.value = 'console';
    this.close();
  }

  protected override render() {
    const t = D.mapping;
    return html`<dialog class="dialog mapping" aria-labelledby="mapping-title" @close=${() => this.close()}
      @click=${(event: Event) => { if (event.target === event.currentTarget) this.close(); }}>
      <div class="dialog-body">
        <header class="dialog-head">
          <h2 id="mapping-title">${t.title}</h2>
          <button class="icon-button" aria-label=${T.close} @click=${() => this.close()}>${icons.close}</button>
        </header>
        ${this.pdo ? this.editor(this.pdo) : html`<p class="empty">${t.none}</p>`}
      </div>
    </dialog>`;
  }

  private editor(pdo: Pdo) {
    const t = D.mapping;
    const bits = this.entries.reduce((sum, one) => sum + one.bits, 0);
    const candidates = this.candidates(pdo);
    const isFull = this.entries.length >= pdo.room;
    const { steps } = this;
    return html`
      <div class="mapping-pdo">
        <label for="mapping-pdo">${t.pdo}</label>
        <select id="mapping-pdo" ?disabled=${this.isBusy} @change=${(event: Event) => this.load(Number((event.target as HTMLSelectElement).value))}>
          ${this.pdos.map((one) => html`<option value=${one.mapping} ?selected=${one === pdo}>${t.name(one.transmits, one.number)} · ${hexIndex(one.mapping)}</option>`)}
        </select>
        <span class="muted num">${pdo.cobId ? t.cobId(pdo.cobId.id.toString(16).toUpperCase(), pdo.cobId.valid) : ''}</span>
      </div>
      ${pdo.transmits || !pdo.cobId ? nothing : html`<p class="note">${t.link(address(pdo.mapping - 0x200, 1))}</p>`}
      ${pdo.isFixed ? html`<p class="note mapping-fixed">${t.fixed}</p>` : nothing}
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
          <option value="">${isFull ? t.full(pdo.room) : t.add}</option>
          ${candidates.map((one) => html`<option value=${state.keyOf(one.index, one.sub)}>${address(one.index, one.sub)} ${one.name} (${t.bits(one.bits)})</option>`)}
        </select>
        <meter min="0" max=${MOST_BITS} .value=${Math.min(bits, MOST_BITS)} aria-label=${t.size}></meter>
        <span class="num note" data-tone=${bits > MOST_BITS ? 'error' : ''}>${t.sum(bits, MOST_BITS)}</span>
      </div>
      ${!pdo.cobId
        ? nothing
        : html`<label class="choice"><input type="checkbox" .checked=${this.isOff} ?disabled=${this.isBusy} @change=${(event: Event) => { this.isOff = (event.target as HTMLInputElement).checked; this.said = []; void this.plan(); }}>
            <span>${t.off}<span class="muted">${t.offHint}</span></span></label>`}
      <section aria-label=${t.frames}>
        <h3 class="mapping-head">${t.frames}</h3>
        <ol class="mapping-steps">${steps.map((step, i) => this.step(step, i, steps))}</ol>
      </section>
      ${this.hint ? html`<p class="note" data-tone="error" role="status">${this.hint}</p>` : nothing}
      <div class="dialog-foot">
        <button ?disabled=${this.isBusy} @click=${() => this.load(pdo.mapping)}>${t.reload}</button>
        <button @click=${() => this.showFrames(pdo)}>${icons.console} ${T.objects.frames}</button>
        <div class="spacer"></div>
        <button class="primary" ?disabled=${this.isBusy || steps.length === 0} @click=${() => this.send()}>${icons.send} ${t.send(steps.length)}</button>
      </div>`;
  }

  private step(step: MappingStep, i: number, steps: MappingStep[]) {
    const said = this.said[i];
    const isFirst = steps[i - 1]?.part !== step.part;
    return html`<li data-tone=${said?.tone ?? ''}>
      ${isFirst ? html`<strong>${D.mapping.step[step.part]}</strong>` : nothing}
      <code class="num">${hexId(step.id, false)} <span>${hexBytes(step.data)}</span></code>
      <span class="said">${said && said.tone !== 'busy' ? html`<b>${said.tone === 'good' ? '✓' : '✗'}</b> ${said.text}` : said ? said.text : html`<span class="muted">${step.words}</span>`}</span>
    </li>`;
  }
}

customElements.define('od-mapping', Mapping);
