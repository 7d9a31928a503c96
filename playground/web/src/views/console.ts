// The frame console: what went over the bus, in order, in plain words.

import { html, nothing } from 'lit';
import { effect } from '@preact/signals-core';
import * as state from '../state';
import { clearConsole, nmt, saveLog, togglePause } from '../actions';
import { tagOf } from '../can/service';
import { hexBytes, hexId } from '../can/text';
import { grouped } from '../can/values';
import { transfer } from '../sim/client';
import { wordsArrived, wordsOf } from '../sim/words';
import { icons } from './icons';
import { Rows, setText } from './rows';
import { View } from './view';
import './frame-detail';

const COLUMNS = ['Time', 'Delta', 'Dir', 'COB-ID', 'Type', 'Len', 'Data', 'Meaning'];

class Console extends View {
  private rows: Rows | undefined;
  private follows = true;
  private anchor = 0;
  private ownScroll = -1;
  private disposers: (() => void)[] = [];
  static override properties = { behind: { state: true } };
  declare behind: boolean;

  constructor() {
    super();
    this.behind = false;
  }

  /** One past the last frame that is shown. */
  private end(): number {
    return state.pausedAt.value ?? state.ring.end;
  }

  protected override firstUpdated(): void {
    const viewport = this.querySelector<HTMLElement>('.frames')!;
    const rows = new Rows(viewport, {
      count: () => Math.max(0, this.end() - state.ring.first),
      make: () => {
        const row = document.createElement('div');
        row.className = 'frame';
        row.setAttribute('role', 'row');
        row.innerHTML = ['time', 'delta', 'dir', 'id', 'tag', 'dlc', 'data', 'words'].map((name) => `<span role="cell" class="${name}"></span>`).join('');
        row.querySelector('.tag')!.append(document.createElement('b'));
        row.addEventListener('click', () => {
          const number = Number(row.dataset['number']);
          state.chosenFrame.value = state.chosenFrame.peek() === number ? null : number;
        });
        return row;
      },
      fill: (row, index) => this.fill(row, state.ring.first + index),
      filled: (from, to) => this.fillWords(from + state.ring.first, to + state.ring.first),
    });
    this.rows = rows;
    // Only a person's hand stops the console from following; a resize does not.
    const release = (): void => {
      requestAnimationFrame(() => {
        const atEnd = viewport.scrollTop + viewport.clientHeight >= viewport.scrollHeight - rows.rowHeight;
        this.follows = atEnd;
        this.behind = !atEnd;
      });
    };
    viewport.addEventListener('wheel', (event) => {
      if (event.deltaY < 0 && viewport.scrollTop > 0) this.follows = false;
      release();
    }, { passive: true });
    viewport.addEventListener('touchmove', release, { passive: true });
    viewport.addEventListener('keydown', (event) => {
      if (!this.moveChoice(event, rows)) release();
    });
    viewport.addEventListener('pointerdown', () => { if (viewport.scrollTop > 0) this.follows = false; });
    viewport.addEventListener('pointerup', release);
    viewport.addEventListener('scroll', () => {
      if (Math.abs(viewport.scrollTop - this.ownScroll) > 2) release();
    }, { passive: true });
    this.disposers.push(
      effect(() => {
        void state.captured.value;
        void state.pausedAt.value;
        this.settle(viewport, rows);
      }),
      effect(() => {
        void state.chosenFrame.value;
        rows.redraw();
      }),
      effect(() => {
        void wordsArrived.value;
        rows.redraw();
      }),
      effect(() => {
        void state.cleared.value;
        this.follows = true;
        this.behind = false;
        this.settle(viewport, rows);
      }),
      effect(() => {
        // A panel that was hidden has no height until its tab is chosen.
        if (state.tab.value === 'console') requestAnimationFrame(() => this.settle(viewport, rows));
      }),
    );
  }

  /** Arrow keys go from frame to frame once one is chosen; Enter chooses the newest. */
  private moveChoice(event: KeyboardEvent, rows: Rows): boolean {
    const { ring, chosenFrame } = state;
    const last = this.end() - 1;
    const now = chosenFrame.value;
    const moves: Record<string, number> = { ArrowUp: -1, ArrowDown: 1, PageUp: -20, PageDown: 20 };
    if (event.key === 'Escape') {
      chosenFrame.value = null;
    } else if (event.key === 'Enter' && now === null && last >= ring.first) {
      chosenFrame.value = last;
    } else if (now !== null && moves[event.key] !== undefined) {
      const next = Math.max(ring.first, Math.min(last, now + moves[event.key]!));
      chosenFrame.value = next;
      if (next < last) this.follows = false;
      rows.reveal(next - ring.first);
    } else {
      return false;
    }
    event.preventDefault();
    return true;
  }

  private settleScheduled = 0;

  /** Goes to the end, or stays with the frames that are being read while old ones fall out. */
  private settle(viewport: HTMLElement, rows: Rows): void {
    this.settleScheduled ||= requestAnimationFrame(() => {
      this.settleScheduled = 0;
      const lost = state.ring.first - this.anchor;
      this.anchor = state.ring.first;
      if (this.follows) this.ownScroll = rows.draw(Number.MAX_SAFE_INTEGER);
      else if (lost > 0) this.ownScroll = rows.draw(viewport.scrollTop - lost * rows.rowHeight);
      else rows.draw();
    });
  }

  private fill(row: HTMLElement, number: number): void {
    row.toggleAttribute('data-chosen', state.chosenFrame.peek() === number);
    if (row.dataset['number'] === String(number)) return;
    const frame = state.ring.get(number);
    if (!frame) return;
    row.dataset['number'] = String(number);
    row.setAttribute('aria-rowindex', String(number + 1));
    const tag = tagOf(frame);
    const cells = row.children;
    const before = state.ring.get(number - 1);
    row.dataset['service'] = tag.service;
    row.dataset['dir'] = frame.fromPage ? 'tx' : 'rx';
    setText(cells[0], (frame.time / 1e6).toFixed(frame.time < 1e10 ? 6 : 3));
    setText(cells[1], before ? `+${delta(frame.time - before.time)}` : '');
    setText(cells[2], frame.fromPage ? 'Tx' : 'Rx');
    setText(cells[3], hexId(frame.id, frame.extended));
    setText(cells[4]?.firstElementChild, tag.text);
    setText(cells[5], frame.disturbed ? '' : String(frame.dlc));
    setText(cells[6], frame.disturbed ? '' : frame.remote ? 'remote request' : hexBytes(frame.data));
    row.toggleAttribute('data-abort', tag.service === 'SDO' && frame.data[0] === 0x80);
    setText(cells[7], '');
  }

  private fillWords(from: number, to: number): void {
    const last = Math.min(to, this.end());
    const numbers = Array.from({ length: Math.max(0, last - from) }, (_, i) => from + i);
    const words = wordsOf(numbers);
    const byNumber = new Map(numbers.map((number, i) => [String(number), words[i]]));
    for (const row of this.querySelectorAll<HTMLElement>('.frame:not([hidden])')) {
      const text = byNumber.get(row.dataset['number'] ?? '') ?? '';
      const cell = row.lastElementChild as HTMLElement;
      if (cell.textContent !== text) {
        cell.textContent = text;
        cell.title = text;
      }
    }
  }

  /** What to try on a bus where hardly anything happened yet. */
  private hints() {
    const node = state.nodeId.value;
    const has = (index: number): boolean => state.objectsByKey.value.has(state.keyOf(index, 0));
    const ask = (index: number, bytes: Uint8Array | null) => () => void transfer({ index, sub: 0, bytes });
    return html`<div class="hints">
      <p>Node ${node} is on the bus. Turn the shaft, type a frame below, or try:</p>
      <div>
        ${has(0x6004) ? html`<button class="small" @click=${ask(0x6004, null)}>Read the position</button>` : nothing}
        <button class="small" @click=${() => nmt(0x01)}>Start the node</button>
        ${has(0x1017) ? html`<button class="small" @click=${ask(0x1017, Uint8Array.of(0xe8, 0x03))}>Heartbeat every second</button>` : nothing}
      </div>
    </div>`;
  }

  private toEnd(): void {
    this.follows = true;
    this.behind = false;
    if (this.rows) this.settle(this.rows.viewport, this.rows);
  }

  protected override render() {
    const paused = state.pausedAt.value;
    void state.captured.value;
    void state.cleared.value;
    const kept = state.ring.end - state.ring.first;
    const waiting = paused === null ? 0 : state.ring.end - Math.max(paused, state.ring.first);
    return html`
      <header class="panel-head">
        <h2>Frames</h2>
        <span class="muted num count" aria-label="Captured frames">${grouped(kept)}</span>
        ${paused === null ? nothing : html`<span class="pill" data-tone="amber">Paused${waiting ? html`, <span class="num">${grouped(waiting)}</span> new` : nothing}</span>`}
        <div class="spacer"></div>
        <button class="small" aria-pressed=${paused !== null} title="Hold the view still, go on capturing (Space)" @click=${togglePause}>
          ${paused === null ? icons.pause : icons.play} ${paused === null ? 'Pause' : 'Go on'}
        </button>
        <button class="small" title="Save as candump log" @click=${saveLog}>${icons.save} <span class="wide">Save log</span></button>
        <button class="small" title="Clear the capture" @click=${clearConsole}>${icons.trash} <span class="wide">Clear</span></button>
      </header>
      <div class="frame-area">
      <div class="frame-table" role="table" aria-label="Frames" aria-rowcount=${kept}>
        <div class="frame-head" role="row">${COLUMNS.map((name, i) => html`<span role="columnheader" class=${['time', 'delta', 'dir', 'id', 'tag', 'dlc', 'data', 'words'][i]!}>${name}</span>`)}</div>
        <div class="frames scroll" tabindex="0" role="rowgroup" aria-label="Captured frames, oldest first"></div>
      </div>
        ${kept > 0 && kept < 4 && paused === null && state.powered.value ? this.hints() : nothing}
        ${kept === 0 ? html`<p class="frames-empty">Nothing on the bus yet. Switch the power on, or send a frame.</p>` : nothing}
        ${this.behind && paused === null ? html`<button class="to-end" @click=${() => this.toEnd()}>${icons.down} Latest frames</button>` : nothing}
      </div>
      <od-frame-detail></od-frame-detail>
    `;
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    for (const dispose of this.disposers.splice(0)) dispose();
    this.rows?.dispose();
  }
}

/** A time difference in as few characters as it takes. */
function delta(micros: number): string {
  if (micros < 1000) return `${Math.round(micros)} µs`;
  if (micros < 1e6) return `${(micros / 1000).toFixed(micros < 1e5 ? 2 : 1)} ms`;
  return `${(micros / 1e6).toFixed(2)} s`;
}

customElements.define('od-console', Console);
