// Choosing what is on the bus: one of ours, or any EDS file.

import { html, nothing, type PropertyValues } from 'lit';
import { effect } from '@preact/signals-core';
import type { Builtin, Diagnostic } from '../sim/api';
import { openDevice, removeDevice } from '../actions';
import * as state from '../state';
import { T } from '../texts';
import { openFile, openText } from './files';
import { icons } from './icons';
import { View } from './view';

/** Findings that are shown at a time: thousands would hold the page up. */
const MORE = 200;

class DeviceDialog extends View {
  static override properties = { node: { state: true }, isOver: { state: true }, most: { state: true } };
  declare node: string;
  /** So many findings are shown. */
  declare most: number;
  declare isOver: boolean;
  private unopen: (() => void) | undefined;

  constructor() {
    super();
    this.node = '1';
    this.isOver = false;
    this.most = MORE;
  }

  protected override firstUpdated(changed: PropertyValues): void {
    super.firstUpdated(changed);
    const dialog = this.querySelector('dialog')!;
    this.unopen = effect(() => {
      const place = state.deviceDialog.value;
      if (place !== null && !dialog.open) {
        this.node = String(place === 'new' ? this.free() : (state.statuses.peek()[place]?.nodeId ?? 1));
        dialog.showModal();
      } else if (place === null && dialog.open) {
        dialog.close();
      }
    });
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.unopen?.();
  }

  private nodeId(): number | null {
    const node = Number(this.node);
    return Number.isInteger(node) && node >= 1 && node <= 127 ? node : null;
  }

  /** The first node ID that nobody has. */
  private free(): number {
    const taken = new Set(state.statuses.peek().map((one) => one.nodeId));
    let node = 1;
    while (taken.has(node)) node += 1;
    return node;
  }

  private get place(): number | 'new' {
    return state.deviceDialog.value ?? state.selectedNode.value;
  }

  private close(): void {
    state.deviceDialog.value = null;
    state.attempt.value = null;
    this.most = MORE;
  }

  private async choose(name: string): Promise<void> {
    const node = this.nodeId();
    if (node === null) return;
    if (await openDevice({ kind: 'builtin', name }, node, this.place)) this.close();
  }

  private async openFirst(files: FileList | null | undefined): Promise<void> {
    const file = files?.[0];
    const node = this.nodeId();
    if (file && node !== null) await openFile(file, node, this.place);
  }

  private async apply(): Promise<void> {
    const node = this.nodeId();
    if (node !== null && (await openDevice(this.source(), node, this.place))) this.close();
  }

  private source() {
    const { place } = this;
    return (place === 'new' ? state.source.value : state.devices.value[place]?.source) ?? state.source.value;
  }

  protected override render() {
    const { place } = this;
    const current = this.source();
    const isNew = place === 'new';
    const isBad = this.nodeId() === null;
    const isTwice = state.statuses.value.some((one, number) => number !== place && one.nodeId === this.nodeId());
    return html`<dialog class="dialog" aria-labelledby="device-title" @close=${() => this.close()}
      @click=${(event: Event) => { if (event.target === event.currentTarget) this.close(); }}>
      <div class="dialog-body">
        <header class="dialog-head">
          <h2 id="device-title">${isNew ? T.dialog.another : T.dialog.title}</h2>
          <button class="icon-button" aria-label=${T.close} @click=${() => this.close()}>${icons.close}</button>
        </header>
        <div class="cards">
          ${families().map(
            ([family, members]) => html`<h3 class="family">${family}</h3>${members.map(
              (one) => html`<button class="card" aria-pressed=${!isNew && current.kind === 'builtin' && current.name === one.name} @click=${() => this.choose(one.name)}>
                <strong>${one.name}</strong><span>${T.dialog.kind(one.title.replace(/^[A-Z0-9]+, /, ''))}</span>
              </button>`,
            )}`,
          )}
        </div>
        <label class="drop" data-over=${this.isOver}
          @dragover=${() => (this.isOver = true)} @dragleave=${() => (this.isOver = false)} @drop=${() => (this.isOver = false)}>
          ${icons.file}
          <span><strong>${T.dialog.open}</strong><span class="muted">${T.dialog.openHint}</span></span>
          <input class="sr" type="file" accept=".eds,.dcf,text/plain" aria-label=${T.dialog.file} @change=${(event: Event) => {
            const input = event.target as HTMLInputElement;
            void this.openFirst(input.files).then(() => (input.value = ''));
          }}>
        </label>
        ${this.faults()}
        <div class="dialog-foot">
          <label for="node-id">${T.dialog.nodeId}</label>
          <input id="node-id" class="num" type="number" min="1" max="127" .value=${this.node} aria-invalid=${isBad} @keydown=${(event: KeyboardEvent) => event.key === 'Enter' && void this.apply()} @input=${(event: Event) => (this.node = (event.target as HTMLInputElement).value)}>
          <span class="note" data-tone=${isBad ? 'error' : ''}>${isBad ? T.dialog.range : isTwice ? T.dialog.twice(this.nodeId() ?? 0) : ''}</span>
          <div class="spacer"></div>
          ${isNew ? nothing : html`<button ?hidden=${state.devices.value.length < 2} @click=${() => { removeDevice(place); this.close(); }}>${T.dialog.remove}</button>
          <button class="primary" ?disabled=${isBad} @click=${() => this.apply()}>${T.dialog.apply}</button>`}
        </div>
      </div>
    </dialog>`;
  }

  private faults() {
    const attempt = state.attempt.value;
    if (!attempt) return nothing;
    const lines = attempt.text.split(/\r\n|\r|\n/);
    const rank = { error: 0, warning: 1 } as Record<string, number>;
    const sorted = [...attempt.diagnostics].sort((a, b) => (rank[a.severity] ?? 2) - (rank[b.severity] ?? 2));
    const errors = attempt.diagnostics.filter((one) => one.severity === 'error').length;
    return html`<section class="faults" role="alert" aria-label=${T.dialog.faults}>
      <header>
        <h3>${T.dialog.broken(attempt.name, errors)}</h3>
        <button class="small" title=${T.dialog.anywayTitle} @click=${() => void openText(attempt.name, attempt.text, this.nodeId() ?? 1, true, this.place)}>${T.dialog.anyway}</button>
      </header>
      <ol class="scroll">${sorted.slice(0, this.most).map((one) => this.fault(one, lines))}</ol>
      ${sorted.length > this.most ? html`<button class="small" @click=${() => (this.most += MORE)}>${T.dialog.more(Math.min(MORE, sorted.length - this.most), sorted.length - this.most)}</button>` : nothing}
    </section>`;
  }

  private fault(one: Diagnostic, lines: string[]) {
    const source = lines[one.line - 1] ?? '';
    const at = Math.max(0, one.column - 1);
    return html`<li data-severity=${one.severity}>
      <span class="num where">${one.line ? `${one.line}:${one.column}` : '–'}</span>
      <span><span class="code">${one.code}</span> ${withCode(one.message)}${source.trim() ? html`<code class="source">${source.slice(0, at)}<mark>${source.slice(at, at + 120).trimEnd()}</mark></code>` : nothing}${one.help ? html`<span class="muted help">${withCode(one.help)}</span>` : nothing}</span>
    </li>`;
  }
}

/** The built-in devices by their series. */
function families(): [string, Builtin[]][] {
  const all = new Map<string, Builtin[]>();
  for (const one of state.builtins.value) {
    const [key] = Object.keys(T.dialog.families).filter((start) => one.name.startsWith(start));
    const family = T.dialog.families[key ?? ''] ?? T.dialog.others;
    all.set(family, [...(all.get(family) ?? []), one]);
  }
  return [...all];
}

/** Text between backticks is code. */
const withCode = (text: string): unknown[] => text.split('`').map((part, i) => (i % 2 ? html`<code>${part}</code>` : part));

customElements.define('od-device-dialog', DeviceDialog);
