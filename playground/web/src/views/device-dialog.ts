// Choosing what is on the bus: one of ours, or any EDS file.

import { html, nothing, type PropertyValues } from 'lit';
import { effect } from '@preact/signals-core';
import type { Diagnostic } from '../sim/api';
import { openDevice } from '../actions';
import * as state from '../state';
import { openFile, openText } from './files';
import { icons } from './icons';
import { View } from './view';

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
      const isWanted = state.deviceDialog.value;
      if (isWanted && !dialog.open) {
        this.node = String(state.device.peek()?.nodeId ?? 1);
        dialog.showModal();
      } else if (!isWanted && dialog.open) {
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

  private close(): void {
    state.deviceDialog.value = false;
    state.attempt.value = null;
  }

  private async choose(name: string): Promise<void> {
    const node = this.nodeId();
    if (node === null) return;
    if (await openDevice({ kind: 'builtin', name }, node)) this.close();
  }

  private async openFirst(files: FileList | null | undefined): Promise<void> {
    const file = files?.[0];
    const node = this.nodeId();
    if (file && node !== null) await openFile(file, node);
  }

  private async apply(): Promise<void> {
    const node = this.nodeId();
    if (node !== null && (await openDevice(state.source.value, node))) this.close();
  }

  protected override render() {
    const current = state.source.value;
    const isBad = this.nodeId() === null;
    return html`<dialog class="dialog" aria-labelledby="device-title" @close=${() => this.close()}
      @click=${(event: Event) => { if (event.target === event.currentTarget) this.close(); }}>
      <div class="dialog-body">
        <header class="dialog-head">
          <h2 id="device-title">Device on the bus</h2>
          <button class="icon-button" aria-label="Close" @click=${() => this.close()}>${icons.close}</button>
        </header>
        <div class="cards">
          ${state.builtins.value.map(
            (one) => html`<button class="card" aria-pressed=${current.kind === 'builtin' && current.name === one.name} @click=${() => this.choose(one.name)}>
              <strong>${one.name}</strong><span>${one.title.replace(/^[A-Z0-9]+, /, '')}</span>
            </button>`,
          )}
        </div>
        <label class="drop" data-over=${this.isOver}
          @dragover=${() => (this.isOver = true)} @dragleave=${() => (this.isOver = false)} @drop=${() => (this.isOver = false)}>
          ${icons.file}
          <span><strong>Open an EDS or DCF file</strong><span class="muted">or drop one anywhere on the page. It stays on this computer.</span></span>
          <input class="sr" type="file" accept=".eds,.dcf,text/plain" aria-label="EDS or DCF file" @change=${(event: Event) => {
            const input = event.target as HTMLInputElement;
            void this.openFirst(input.files).then(() => (input.value = ''));
          }}>
        </label>
        ${this.faults()}
        <div class="dialog-foot">
          <label for="node-id">Node ID</label>
          <input id="node-id" class="num" type="number" min="1" max="127" .value=${this.node} aria-invalid=${isBad} @keydown=${(event: KeyboardEvent) => event.key === 'Enter' && void this.apply()} @input=${(event: Event) => (this.node = (event.target as HTMLInputElement).value)}>
          <span class="note" data-tone=${isBad ? 'error' : ''}>${isBad ? '1 to 127' : ''}</span>
          <div class="spacer"></div>
          <button class="primary" ?disabled=${isBad} @click=${() => this.apply()}>Apply node ID</button>
        </div>
      </div>
    </dialog>`;
  }

  private faults() {
    const attempt = state.attempt.value;
    if (!attempt) return nothing;
    const lines = attempt.text.split(/\r\n|\r|\n/);
    const errors = attempt.diagnostics.filter((one) => one.severity === 'error').length;
    return html`<section class="faults" role="alert" aria-label="What is wrong with the file">
      <header>
        <h3>${attempt.name} cannot run: ${errors} error${errors === 1 ? '' : 's'}</h3>
        <button class="small" title="Leave out what is wrong" @click=${() => void openText(attempt.name, attempt.text, this.nodeId() ?? 1, true)}>Run anyway</button>
      </header>
      <ol class="scroll">${attempt.diagnostics.map((one) => this.fault(one, lines))}</ol>
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

/** Text between backticks is code. */
const withCode = (text: string): unknown[] => text.split('`').map((part, i) => (i % 2 ? html`<code>${part}</code>` : part));

customElements.define('od-device-dialog', DeviceDialog);
