// The page: bar, three panels, and on a phone one of them at a time.

import { html, nothing } from 'lit';
import { effect } from '@preact/signals-core';
import * as state from '../state';
import { togglePause } from '../actions';
import { icons } from './icons';
import { View } from './view';
import { openFile } from './files';
import './topbar';
import './encoder';
import './console';
import './send';
import './objects';
import './device-dialog';
import './help';
import './offer';

const TABS: { tab: state.Tab; text: string; icon: unknown }[] = [
  { tab: 'encoder', text: 'Encoder', icon: icons.encoder },
  { tab: 'console', text: 'Bus', icon: icons.console },
  { tab: 'objects', text: 'Objects', icon: icons.objects },
];

class App extends View {
  static override properties = { isDropping: { state: true } };
  declare isDropping: boolean;

  constructor() {
    super();
    this.isDropping = false;
    window.addEventListener('keydown', (event) => this.onKey(event));
    window.addEventListener('dragover', (event) => {
      if (!event.dataTransfer?.types.includes('Files')) return;
      event.preventDefault();
      this.isDropping = true;
    });
    window.addEventListener('dragleave', (event) => {
      if (event.relatedTarget === null) this.isDropping = false;
    });
    window.addEventListener('drop', (event) => {
      const file = event.dataTransfer?.files[0];
      if (!file) return;
      event.preventDefault();
      this.isDropping = false;
      void openFile(file, state.nodeId.value, state.deviceDialog.value ?? state.selectedNode.value);
    });
    effect(() => {
      const { value } = state.toast;
      if (value) setTimeout(() => state.toast.value === value && (state.toast.value = null), value.action ? 20_000 : 6000);
    });
  }

  private onKey(event: KeyboardEvent): void {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const target = event.target as HTMLElement;
    if (event.key === '?' && !target.closest('input, textarea, dialog')) state.helpDialog.value = true;
    if (event.key !== ' ') return;
    if (target.closest('input, select, textarea, button, summary, dialog, [role=slider], [role=option], [role=tab]')) return;
    event.preventDefault();
    togglePause();
  }

  protected override render() {
    const tab = state.tab.value;
    return html`
      <od-topbar></od-topbar>
      
      <main class="bench" data-tab=${tab}>
        <h1 class="sr">Virtual CANopen encoder</h1>
        <div class="side">
          <od-encoder class="panel" data-panel="encoder"></od-encoder>
          <od-objects class="panel" data-panel="objects"></od-objects>
        </div>
        <div class="panel bus" data-panel="console">
          <od-console></od-console>
          <od-send></od-send>
        </div>
      </main>
      <nav aria-label="Panels"><div class="tabs" role="tablist" aria-label="Panels">
        ${TABS.map(
          (entry) => html`<button role="tab" aria-selected=${entry.tab === tab} @click=${() => (state.tab.value = entry.tab)}>
            ${entry.icon}<span>${entry.text}</span>
          </button>`,
        )}
      </div></nav>
      <od-device-dialog></od-device-dialog>
      <od-help></od-help>
      <od-share></od-share>
      <od-mapping></od-mapping>
      <od-offers></od-offers>
      <div class="toasts" role="status" aria-live="polite">
        ${state.toast.value
          ? html`<div class="toast" data-tone=${state.toast.value.tone}>
              <span>${state.toast.value.text}</span>
              ${state.toast.value.action ? html`<button class="small" @click=${() => { state.toast.value?.action?.run(); state.toast.value = null; }}>${state.toast.value.action.text}</button>` : nothing}
              <button class="quiet" aria-label="Dismiss" @click=${() => (state.toast.value = null)}>${icons.close}</button>
            </div>`
          : nothing}
      </div>
      ${this.isDropping ? html`<div class="drop-veil"><p>${icons.file} Drop the EDS file to run it</p></div>` : nothing}
      ${state.health.value === 'failed'
        ? html`<div class="failed" role="alert">
            <p>The simulation does not run in this browser.</p>
            <button class="primary" @click=${() => location.reload()}>Load the page again</button>
          </div>`
        : nothing}
    `;
  }
}

customElements.define('od-app', App);
