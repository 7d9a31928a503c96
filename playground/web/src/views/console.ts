// The frame console: filter and views, the frames, the selected frame, and the bus load.

import { html, nothing } from 'lit';
import { effect } from '@preact/signals-core';
import * as state from '../state';
import { find, filterError, filterText, folds, nextBookmark, passing, refiltered, setFilter, setFolds, trace, view } from '../capture';
import { clearConsole, saveLog, togglePause } from '../actions';
import { grouped } from '../format';
import { T } from '../texts';
import { openFile } from './files';
import { icons } from './icons';
import { load, View } from './view';
import './frame-list';

const FORMATS = ['log', 'asc', 'trc', 'pcapng'] as const;

/** The views of the capture; all but the first are loaded on request. */
const VIEWS: [typeof view.value, (() => Promise<unknown>)?][] = [
  ['order'],
  ['ids', () => import('../seeing/identifiers')],
  ['nodes', () => import('../seeing/node-list')],
  ['plot', () => import('../seeing/plot')],
  ['diagnosis', () => import('../seeing/diagnosis')],
];

class Console extends View {
  static override properties = { isFinding: { state: true }, hasTrigger: { state: true }, finding: { state: true }, findNote: { state: true } };
  declare isFinding: boolean;
  declare hasTrigger: boolean;
  declare finding: string;
  declare findNote: string;

  constructor() {
    super();
    this.isFinding = false;
    this.hasTrigger = false;
    this.finding = '';
    this.findNote = '';
    // The details of a frame are loaded with the first frame that is selected.
    effect(() => {
      if (state.chosenFrame.value !== null) load(() => import('./frame-detail'));
    });
    // The advice for bus-off is loaded when the page or a node is bus-off.
    effect(() => {
      if ([state.line.value, ...state.statuses.value].some((one) => one?.controller === 'bus-off')) load(() => import('../seeing/bus-off'));
    });
    this.addEventListener('keydown', (event) => {
      const isFind = (event.key === 'f' && (event.ctrlKey || event.metaKey)) || (event.key === '/' && !(event.target as HTMLElement).closest('input'));
      if (!isFind) return;
      event.preventDefault();
      this.openFind();
    });
  }

  private openFind(): void {
    this.isFinding = true;
    void this.updateComplete.then(() => this.querySelector<HTMLInputElement>('.find input')?.select());
  }

  private showTrigger(): void {
    this.hasTrigger = !this.hasTrigger;
    load(() => import('../seeing/trigger-bar'));
  }

  private async onFind(event: KeyboardEvent): Promise<void> {
    if (event.key === 'Escape') {
      this.isFinding = false;
      this.querySelector<HTMLElement>('.frames')?.focus();
    }
    if (event.key !== 'Enter') return;
    event.preventDefault();
    await this.findNext(event.shiftKey ? -1 : 1);
  }

  private async findNext(direction: 1 | -1): Promise<void> {
    const found = await find(this.finding, direction);
    this.findNote = typeof found === 'string' ? found : found ? '' : T.frames.notFound;
  }

  private filterBar() {
    const error = filterError.value;
    const t = T.frames;
    return html`<div class="filter-bar">
      <label class="search grow">${icons.filter}<input type="search" class="num" placeholder=${t.filterHint} aria-label=${t.filter} autocomplete="off" spellcheck="false"
        aria-invalid=${error !== null} aria-describedby="filter-note" .value=${filterText.value} @input=${(event: Event) => setFilter((event.target as HTMLInputElement).value)}></label>
      <span class="segmented" role="group" aria-label=${t.view}>
        ${VIEWS.map(([name, part]) => html`<button class="small" aria-pressed=${view.value === name} @click=${() => show(name, part)}>${{ ...t, plot: T.plot }[name]}</button>`)}
      </span>
      <button class="icon-button" aria-pressed=${folds.value} aria-label=${t.folds} title=${t.folds} @click=${() => setFolds(!folds.value)}>${icons.fold}</button>
      <button class="icon-button" aria-label=${t.find} title=${t.findTitle} @click=${() => this.openFind()}>${icons.search}</button>
      <button class="icon-button" aria-pressed=${this.hasTrigger} aria-label=${t.trigger} title=${t.triggerTitle} @click=${() => this.showTrigger()}>${icons.trigger}</button>
      ${state.bookmarks.value.size ? html`<button class="icon-button" aria-label=${t.nextMark} title=${t.nextMark} @click=${() => nextBookmark(1)}>${icons.mark}</button>` : nothing}
      ${error ? html`<p id="filter-note" class="note" data-tone="error" role="status">${caret(filterText.value, error.at)} ${error.error}</p>` : nothing}
      ${this.isFinding
        ? html`<div class="find"><input class="num grow" aria-label=${t.find} title=${t.findTitle} placeholder=${t.findHint} autocomplete="off" spellcheck="false" .value=${this.finding}
            @input=${(event: Event) => { this.finding = (event.target as HTMLInputElement).value; this.findNote = ''; }} @keydown=${(event: KeyboardEvent) => void this.onFind(event)}>
            <button class="small" title=${t.findTitle} @click=${() => void this.findNext(1)}>${icons.down}<span class="sr">${t.find}</span></button>
            <span class="note" data-tone="error" role="status" ?hidden=${!this.findNote}>${this.findNote}</span></div>`
        : nothing}
      ${this.hasTrigger ? html`<od-trigger></od-trigger>` : nothing}
    </div>`;
  }

  protected override render() {
    const paused = state.pausedAt.value;
    void state.captured.value;
    void state.cleared.value;
    void refiltered.value;
    const kept = state.ring.end - state.ring.first;
    const waiting = paused === null ? 0 : state.ring.end - Math.max(paused, state.ring.first);
    const t = T.frames;
    const trigger = state.trigger.value;
    return html`
      <header class="panel-head">
        <h2>${t.title}</h2><od-shelf></od-shelf><od-dbc></od-dbc>
        <span class="muted num count" aria-label=${t.captured}>${grouped(kept)}</span>
        ${trace.filter ? html`<span class="muted num passing" role="status">${t.passing(grouped(trace.count), grouped(kept))}</span>
          <button class="small" title=${t.saveFilteredTitle} ?disabled=${trace.count === 0} @click=${() => void saveLog('log', passing())}>${icons.save} ${t.saveFiltered}</button>` : nothing}
        ${paused === null ? nothing : html`<span class="pill" data-tone="amber">${t.paused}${waiting ? html`, <span class="num">${grouped(waiting)}</span> ${t.fresh}` : nothing}</span>`}
        ${trigger ? html`<button class="pill" data-tone=${trigger.phase === 'armed' ? '' : 'amber'} title=${trigger.text} @click=${() => { this.hasTrigger = true; }}>${t.triggers[trigger.phase]}</button>` : nothing}
        <div class="spacer"></div>
        <button class="small" aria-pressed=${paused !== null} title=${t.pauseTitle} @click=${togglePause}>
          ${paused === null ? icons.pause : icons.play} ${paused === null ? t.pause : t.goOn}
        </button>
        <button class="small" title=${t.saveTitle} @click=${() => void saveLog('log')}>${icons.save} <span class="wide">${t.save}</span></button>
        <label class="select bordered format" title=${t.saveTitle}><select aria-label=${t.saveTitle} @change=${(event: Event) => {
          const select = event.target as HTMLSelectElement;
          if (select.value) void saveLog(select.value as (typeof FORMATS)[number]);
          select.value = '';
        }}><option value="">…</option>${FORMATS.map((format) => html`<option value=${format}>${t.formats[format]}</option>`)}</select></label>
        <label class="button small" title=${t.open}>${icons.file} <span class="wide">${t.open}</span><input class="sr" type="file" accept=".log,.asc,.blf,.trc,.pcap,.pcapng,.candump,.dump,.txt,.dbc" aria-label=${t.open} @change=${(event: Event) => {
          const input = event.target as HTMLInputElement;
          if (input.files?.[0]) void openFile(input.files[0], 1, 'new').then(() => (input.value = ''));
        }}></label>
        <button class="small" title=${t.clearTitle} @click=${clearConsole}>${icons.trash} <span class="wide">${t.clear}</span></button>
      </header>
      ${this.filterBar()}
      <od-frames ?hidden=${view.value !== 'order'}></od-frames>
      ${view.value === 'ids' ? html`<od-identifiers></od-identifiers>` : nothing}
      ${view.value === 'nodes' ? html`<od-node-list></od-node-list>` : nothing}
      ${view.value === 'plot' ? html`<od-plot></od-plot>` : nothing}
      ${view.value === 'diagnosis' ? html`<od-diagnosis></od-diagnosis>` : nothing}
      <od-frame-detail></od-frame-detail>
      <od-bus-off></od-bus-off>
      <od-bus-status></od-bus-status>
    `;
  }
}

function show(name: typeof view.value, part?: () => Promise<unknown>): void {
  view.value = name;
  if (part) load(part);
}

/** The invalid part of a text, and the rest. */
const caret = (text: string, at: number) => (at < text.length ? html`<code>${text.slice(at, at + 16)}</code>:` : nothing);

/** Percentage from which frames of low priority have no room on the line. */
const FULL = 98;

/** The bus load, four times a second. */
class BusStatus extends View {
  private timer = 0;
  private stopEffect: (() => void) | undefined;

  protected override firstUpdated(): void {
    this.stopEffect = effect(() => {
      void state.now.value;
      this.timer ||= window.setTimeout(() => {
        this.timer = 0;
        trace.follow();
        this.requestUpdate();
      }, 250);
    });
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.stopEffect?.();
  }

  protected override render() {
    const line = state.line.peek();
    const { frames, bits } = trace.lately(state.now.peek());
    const rate = line?.rate ?? 500;
    const load = line?.real ? state.load.peek() : (bits / (rate * 1000)) * 100;
    const isFull = load >= FULL;
    const t = T.frames;
    const tone = line?.controller === 'bus-off' ? 'bad' : line?.controller === 'error passive' ? 'amber' : '';
    const left = state.toSend.peek();
    return html`<footer class="bus-status" aria-label=${T.send.bus}>
      <span class="meter" ?data-full=${isFull} title=${t.load(load.toFixed(1), line?.rate ?? null)}><i style=${`width: ${Math.min(100, load).toFixed(1)}%`}></i></span>
      <span class="num">${t.load(load < 10 ? load.toFixed(1) : load.toFixed(0), line?.rate ?? null)}</span>
      ${isFull ? html`<span class="bad">${t.full}</span>` : nothing}
      <span class="num">${t.perSecond(grouped(frames))}</span>
      ${trace.errors ? html`<span class="num bad">${t.lost(grouped(trace.errors))}</span>` : nothing}
      ${left ? html`<span class="num">${t.replaying(grouped(left))}</span>` : nothing}
      <span class="spacer"></span>
      ${line?.real ? html`<span class=${tone}>${t.busState(line.controller)}</span>` : nothing}
    </footer>`;
  }
}

customElements.define('od-bus-status', BusStatus);
customElements.define('od-console', Console);
