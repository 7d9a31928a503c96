// The dialog that chooses a device: a built-in one, or any EDS file.

import { html, nothing, type PropertyValues } from 'lit';
import { effect } from '@preact/signals-core';
import type { Builtin } from '../sim/api';
import { openDevice, removeDevice, undoReplace } from '../actions';
import { sheet } from '../sheet';
import * as state from '../state';
import { T } from '../texts';
import { openFile } from './files';
import { icons } from './icons';
import { View } from './view';

await sheet('dialogs');

class DeviceDialog extends View {
  static override properties = { node: { state: true }, isOver: { state: true } };
  declare node: string;
  declare isOver: boolean;
  private unopen: (() => void) | undefined;

  constructor() {
    super();
    this.node = '1';
    this.isOver = false;
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

  /** The lowest node ID that no device has. */
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
  }

  private async choose(name: string): Promise<void> {
    const node = this.nodeId();
    if (node === null) return;
    if ((await openDevice({ kind: 'builtin', name }, node, this.place)).node !== null) this.close();
  }

  private async openFirst(files: FileList | null | undefined): Promise<void> {
    const file = files?.[0];
    const node = this.nodeId();
    if (file && node !== null) await openFile(file, node, this.place);
  }

  private async apply(): Promise<void> {
    const node = this.nodeId();
    if (node !== null && (await openDevice(this.source(), node, this.place)).node !== null) this.close();
  }

  /** Opens the EDS of the device in the editor. */
  private edit(): void {
    const { place } = this;
    const source = this.source();
    const nodeId = this.nodeId() ?? 1;
    this.close();
    state.editing.value = { name: source.kind === 'eds' ? source.name : `${source.name}.eds`, text: source.kind === 'eds' ? source.text : '', builtin: source.kind === 'eds' ? '' : source.name, nodeId, place, at: null };
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
        ${state.real.value ? html`<od-real-kind></od-real-kind>` : nothing}
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
          <input class="sr" type="file" accept=".eds,.dcf,.xdd,.xdc,text/plain" aria-label=${T.dialog.file} @change=${(event: Event) => {
            const input = event.target as HTMLInputElement;
            void this.openFirst(input.files).then(() => (input.value = ''));
          }}>
        </label>
        ${isNew ? nothing : html`<div class="button-row">
          <button @click=${() => this.edit()}>${T.dialog.edit(current.name)}</button>
          ${state.replaced.value ? html`<button @click=${() => { this.close(); void undoReplace(); }}>${T.dialog.undo(state.replaced.value.name)}</button>` : nothing}
        </div>`}
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

customElements.define('od-device-dialog', DeviceDialog);
