// The page: bar and three panels; on a phone one panel at a time.

import { html, nothing, type TemplateResult } from 'lit';
import { effect } from '@preact/signals-core';
import * as state from '../state';
import { togglePause } from '../actions';
import { T } from '../texts';
import { besideWord } from './beside';
import { icons } from './icons';
import { View } from './view';
import { openFile } from './files';
import './topbar';
import { deviceWord } from './encoder';
import './console';
import './send';
import './objects';
import './offer';

const TABS = ['encoder', 'console', 'objects', 'lesson'] as const satisfies state.Tab[];

/** The parts of the page, in the order of F6. */
const PARTS = ['.dial', 'od-encoder .switch', '.object-rows', '.lesson', '.frames', '#raw-frame', '.topbar .device-button'];

/** Milliseconds that a message without a fault stays. */
const READ = 20_000;

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
      const { files, items } = event.dataTransfer!;
      const [file] = files;
      if (!file) return;
      event.preventDefault();
      this.isDropping = false;
      // Several files, or a folder: lessons.
      const entries = [...items].map((item) => item.webkitGetAsEntry()).filter((entry) => entry !== null);
      if (entries[0]?.isDirectory || (files.length > 1 && [...files].every(({ name }) => /\.md$/i.test(name)))) return void import('../lessons/own').then(async ({ filesOf, openAll }) => openAll(await filesOf(entries)));
      void openFile(file, state.nodeId.value, state.deviceDialog.value ?? state.selectedNode.value);
    });
    // Most visits open no dialog and no lesson.
    effect(() => {
      if (state.deviceDialog.value !== null) void import('./device-dialog');
    });
    effect(() => {
      if (state.helpDialog.value) void import('./help');
    });
    effect(() => {
      if (state.lesson.value) void import('./lesson');
    });
    effect(() => {
      if (state.status.value?.shaft === null) void import('../machine/panel');
    });
    effect(() => {
      if (state.tour.value !== null) void import('./tour');
    });
    effect(() => {
      if (state.lessonDialog.value) void import('./lessons');
    });
    effect(() => {
      if (state.report.value) void import('../editor/report');
    });
    effect(() => {
      if (state.editing.value) void import('../editor/dialog');
    });
    effect(() => {
      const { value } = state.toast;
      // An error message stays until the user closes it.
      if (value?.tone === 'info') setTimeout(() => state.toast.value === value && (state.toast.value = null), READ);
    });
  }

  /** Moves the focus to the next visible part of the page. */
  private goOn(by: number): void {
    const home = (part: Element | null): Element | null => part?.closest('.panel, od-send, od-topbar') ?? null;
    const seen = PARTS.flatMap((part) => [...this.querySelectorAll<HTMLElement>(part)].slice(0, 1)).filter((part) => part.checkVisibility());
    // The first existing control of each part: a device may have no shaft.
    const parts = seen.filter((part, i) => seen.findIndex((other) => home(other) === home(part)) === i);
    const at = parts.findIndex((part) => home(part) === home(document.activeElement));
    parts[at < 0 ? 0 : (at + by + parts.length) % parts.length]?.focus();
  }

  private onKey(event: KeyboardEvent): void {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    const target = event.target as HTMLElement;
    if (event.key === 'F6' && !target.closest('dialog')) {
      event.preventDefault();
      this.goOn(event.shiftKey ? -1 : 1);
    }
    if (event.key === '/' && !target.closest('input, select, textarea, dialog')) {
      event.preventDefault();
      state.tab.value = 'console';
      void this.updateComplete.then(() => this.querySelector<HTMLElement>('.filter-bar input')?.focus());
    }
    if (event.key === '?' && !target.closest('input, textarea, dialog')) state.helpDialog.value = true;
    if (event.key !== ' ') return;
    if (target.closest('input, select, textarea, button, summary, dialog, [role=slider], [role=option], [role=tab]')) return;
    event.preventDefault();
    togglePause();
  }

  private toast(): TemplateResult {
    const { value } = state.toast;
    const close = (): void => void (state.toast.value = null);
    return html`<div class="toasts" role="status" aria-live="polite">${value
      ? html`<div class="toast" data-tone=${value.tone}>
          <span>${value.text}</span>
          ${value.action ? html`<button class="small" @click=${() => { value.action?.run(); close(); }}>${value.action.text}</button>` : nothing}
          <button class="quiet" aria-label=${T.app.dismiss} @click=${close}>${icons.close}</button>
        </div>`
      : nothing}</div>`;
  }

  protected override render() {
    const tab = state.tab.value;
    const lab = state.lab.value;
    const isBeside = state.isBeside.value;
    return html`
      <od-topbar></od-topbar>
      <div><od-tour></od-tour><od-offers></od-offers><od-report></od-report></div>
      <main class="bench" data-tab=${tab} ?data-lesson=${isBeside} data-encoder=${state.encoderOpen.value ? 'open' : 'folded'}>
        <h1 class="sr">${T.app.title}</h1>
        <div class="side">
          ${state.real.value && state.status.value?.real !== false ? html`<od-real-node class="panel" data-panel="encoder"></od-real-node>` : html`<od-encoder class="panel" data-panel="encoder"></od-encoder>`}
          ${lab ? html`<od-lab class="panel" data-panel="lesson"></od-lab>` : isBeside ? html`<od-lesson class="panel" data-panel="lesson"></od-lesson>` : nothing}
          <od-objects class="panel" data-panel="objects"></od-objects>
        </div>
        <div class="panel bus" data-panel="console">
          <od-console></od-console>
          <od-send></od-send>
        </div>
      </main>
      <div class="foot">${this.toast()}<nav aria-label=${T.app.panels}><div class="tabs" role="tablist" aria-label=${T.app.panels}>
        ${TABS.filter((one) => one !== 'lesson' || isBeside).map(
          (one) => html`<button role="tab" aria-selected=${one === tab} @click=${() => (state.tab.value = one)}>
            ${icons[one]}<span>${one === 'encoder' ? deviceWord() : one === 'lesson' ? besideWord() : T.app.tabs[one]}</span>
          </button>`,
        )}
      </div></nav></div>
      <od-device-dialog></od-device-dialog>
      <od-help></od-help>
      <od-share></od-share>
      <od-connect></od-connect>
      <od-mapping></od-mapping>
      <od-lessons></od-lessons>
      <od-editor></od-editor>
      ${this.isDropping ? html`<div class="drop-veil"><p>${icons.file} ${T.app.drop}</p></div>` : nothing}
      ${state.health.value === 'failed'
        ? html`<div class="failed" role="alert">
            <p>${T.app.failed}</p>
            <button class="primary" @click=${() => location.reload()}>${T.app.again}</button>
          </div>`
        : nothing}
    `;
  }
}

customElements.define('od-app', App);
