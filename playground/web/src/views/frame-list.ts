// The frames in order, in words; only visible rows are drawn.

import { html, nothing } from 'lit';
import { effect } from '@preact/signals-core';
import * as state from '../state';
import { gap, refiltered, reveal, revealed, toggleBookmark, trace } from '../capture';
import { sendLine } from '../actions';
import { hexByte, hexId } from '../format';
import { decode } from '../codec';
import { address, showValue } from '../format';
import { transfer } from '../sim/sdo';
import type { Frame } from '../trace/ring';
import type { Transfer } from '../sim/api';
import { wordsArrived, wordsOf } from '../sim/words';
import { T } from '../texts';
import { icons } from './icons';
import { cells, Rows, setText } from './rows';
import { View } from './view';

/** Number of characters from which a text takes two small lines. */
const LONG = 44;

const COLUMNS = ['time', 'delta', 'dir', 'id', 'tag', 'dlc', 'data', 'words'] as const;

/** Calls `resized` when an element has another size; the result ends that. */
function watched(element: HTMLElement, resized: () => void): () => void {
  const sizes = new ResizeObserver(resized);
  sizes.observe(element);
  return () => sizes.disconnect();
}

class FrameList extends View {
  private rows: Rows | undefined;
  private follows = true;
  /** Counts changes of rows that are already visible. */
  private stale = 0;
  private ownScroll = -1;
  private disposers: (() => void)[] = [];
  static override properties = { behind: { state: true } };
  declare behind: boolean;

  constructor() {
    super();
    this.behind = false;
  }

  /** Number of rows; a paused view keeps those of its moment. */
  private count(): number {
    const paused = state.pausedAt.value;
    return paused === null ? trace.count : trace.rowsBefore(paused);
  }

  protected override firstUpdated(): void {
    const viewport = this.querySelector<HTMLElement>('.frames')!;
    const rows = new Rows(viewport, {
      count: () => this.count(),
      make: () => {
        const row = document.createElement('div');
        row.className = 'frame';
        row.setAttribute('role', 'row');
        row.append(...cells(['time', 'delta', 'dir', 'id', 'tag', 'dlc', 'data', 'words'], 'cell'));
        row.querySelector('.tag')!.append(document.createElement('b'));
        row.addEventListener('click', () => {
          const number = Number(row.dataset['number']);
          state.chosenFrame.value = state.chosenFrame.peek() === number ? null : number;
        });
        return row;
      },
      fill: (row, index) => this.fill(row, trace.numberAt(index)),
      filled: (from, to) => this.fillWords(from, to),
    });
    this.rows = rows;
    // Only the user stops the console from following; a resize does not.
    const hold = (): void => {
      this.follows = false;
      this.behind = true;
    };
    const look = (mayFollow: boolean): void => {
      requestAnimationFrame(() => {
        const atEnd = viewport.scrollTop + viewport.clientHeight >= viewport.scrollHeight - rows.rowHeight;
        if (!atEnd) return hold();
        if (!mayFollow) return;
        this.follows = true;
        this.behind = false;
      });
    };
    // Scrolling up stops it at once: until the browser has scrolled, the list is still at its end, and a busy one would stay there.
    const release = (isUp: boolean): void => (isUp && viewport.scrollTop > 0 ? hold() : look(true));
    viewport.addEventListener('wheel', (event) => release(event.deltaY < 0 && !event.ctrlKey), { passive: true });
    let touched = 0;
    const finger = (event: TouchEvent): number => event.touches[0]?.clientY ?? touched;
    viewport.addEventListener('touchstart', (event) => { touched = finger(event); }, { passive: true });
    viewport.addEventListener('touchmove', (event) => {
      release(finger(event) > touched);
      touched = finger(event);
    }, { passive: true });
    viewport.addEventListener('keydown', (event) => {
      if (!this.moveChoice(event)) release(['ArrowUp', 'PageUp', 'Home'].includes(event.key));
    });
    viewport.addEventListener('pointerdown', () => { if (viewport.scrollTop > 0) this.follows = false; });
    viewport.addEventListener('pointerup', () => look(true));
    let top = 0;
    viewport.addEventListener('scroll', () => {
      const isUp = viewport.scrollTop < top;
      top = viewport.scrollTop;
      // Smooth scrolling up begins at the end.
      if (Math.abs(top - this.ownScroll) > 2) look(!isUp);
    }, { passive: true });
    this.disposers.push(
      effect(() => {
        void state.captured.value;
        void state.pausedAt.value;
        this.settle(viewport, rows);
      }),
      effect(() => {
        void state.chosenFrame.value;
        void state.bookmarks.value;
        void gap.value;
        this.stale += 1;
        rows.redraw();
      }),
      effect(() => {
        const wanted = revealed.value;
        if (!wanted) return;
        const row = trace.rowOf(wanted.number);
        if (row < this.count() - 1) this.follows = false;
        this.behind = !this.follows;
        requestAnimationFrame(() => rows.reveal(row));
      }),
      // The detail of a frame takes room of the list: its row stays in sight.
      watched(viewport, () => {
        const chosen = state.chosenFrame.peek();
        if (chosen !== null && !this.follows) rows.reveal(trace.rowOf(chosen));
      }),
      effect(() => {
        void refiltered.value;
        this.stale += 1;
        this.settle(viewport, rows);
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
        // A hidden panel has no height until its tab is selected.
        if (state.tab.value === 'console') requestAnimationFrame(() => this.settle(viewport, rows));
      }),
    );
  }

  /** Arrow keys move the selection; Enter selects the newest frame. */
  private moveChoice(event: KeyboardEvent): boolean {
    const { chosenFrame } = state;
    const last = this.count() - 1;
    const now = chosenFrame.value;
    const moves: Record<string, number> = { ArrowUp: -1, ArrowDown: 1, PageUp: -20, PageDown: 20 };
    if (event.key === 'Escape') {
      chosenFrame.value = null;
    } else if (event.key === 'Enter' && now === null && last >= 0) {
      chosenFrame.value = trace.numberAt(last);
    } else if (event.key.toLowerCase() === 'b' && now !== null) {
      toggleBookmark(now);
    } else if (now !== null && moves[event.key] !== undefined) {
      const next = Math.max(0, Math.min(last, trace.rowOf(now) + moves[event.key]!));
      if (next < last) this.follows = false;
      reveal(trace.numberAt(next));
    } else {
      return false;
    }
    event.preventDefault();
    return true;
  }

  private settleScheduled = 0;

  /** Scrolls to the end, or keeps the visible frames in place while old ones are removed. */
  private settle(viewport: HTMLElement, rows: Rows): void {
    this.settleScheduled ||= requestAnimationFrame(() => {
      this.settleScheduled = 0;
      const lost = trace.follow();
      if (this.follows) this.ownScroll = rows.draw(Number.MAX_SAFE_INTEGER);
      else if (lost > 0) this.ownScroll = rows.draw(viewport.scrollTop - lost * rows.rowHeight);
      else rows.draw();
    });
  }

  private fill(row: HTMLElement, number: number): void {
    row.toggleAttribute('data-chosen', state.chosenFrame.peek() === number);
    const fold = trace.fold(number);
    // The row of a running transfer grows; all others stay as they were drawn.
    const version = `${number} ${this.stale} ${fold?.frames.length ?? 0}`;
    if (row.dataset['version'] === version) return;
    const frame = state.ring.get(number);
    if (!frame) return;
    row.dataset['version'] = version;
    row.dataset['number'] = String(number);
    row.setAttribute('aria-rowindex', String(number + 1));
    const tag = frame.tag;
    const cells = row.children;
    row.dataset['service'] = tag.service;
    row.dataset['dir'] = frame.fromPage ? 'tx' : 'rx';
    row.toggleAttribute('data-marked', state.bookmarks.peek().has(number));
    row.toggleAttribute('data-fold', fold !== null);
    setText(cells[0], (frame.time / 1e6).toFixed(frame.time < 1e10 ? 6 : 3));
    const before = gap.peek() === 'cycle' ? trace.before(number) : state.ring.get(number - 1);
    setText(cells[1], before ? `+${delta(frame.time - before.time)}` : '');
    setText(cells[2], frame.fromPage ? 'Tx' : 'Rx');
    setText(cells[3], hexId(frame.id, frame.extended));
    setText(cells[4]?.firstElementChild, tag.text);
    setText(cells[5], frame.disturbed ? '' : String(frame.dlc));
    fillData(cells[6]!, frame, fold, trace.before(number));
    row.toggleAttribute('data-abort', !frame.disturbed && ((tag.service === 'SDO' && frame.data[0] === 0x80) || fold?.state === 'aborted'));
    setText(cells[7], '');
  }

  private fillWords(from: number, to: number): void {
    const last = Math.min(to, this.count());
    const numbers = Array.from({ length: Math.max(0, last - from) }, (_, i) => trace.numberAt(from + i));
    const folds = numbers.map((number) => trace.fold(number));
    // The last frame of an aborted transfer has the reason.
    const words = wordsOf(numbers.map((number, i) => (folds[i]?.state === 'aborted' ? folds[i]!.frames.at(-1)! : number)));
    const byNumber = new Map(numbers.map((number, i) => [String(number), foldWords(folds[i], words[i])]));
    for (const row of this.querySelectorAll<HTMLElement>('.frame:not([hidden])')) {
      const text = byNumber.get(row.dataset['number'] ?? '') ?? '';
      const cell = row.lastElementChild as HTMLElement;
      if (cell.textContent !== text) {
        cell.textContent = text;
        cell.title = text;
        row.toggleAttribute('data-long', text.length > LONG);
      }
    }
  }

  /** Suggestions for a bus with hardly any frames. */
  private hints() {
    const node = state.nodeId.value;
    const has = (index: number): boolean => state.objectsByKey.value.has(state.keyOf(index, 0));
    const ask = (index: number, bytes: Uint8Array | null) => () => void transfer({ index, sub: 0 }, bytes);
    const hasShaft = state.status.value?.shaft !== null;
    return html`<div class="hints">
      <p class="about">${hasShaft ? T.send.about : T.send.aboutOther}</p>
      <p>${T.send.node(node, hasShaft)}</p>
      <div>
        ${has(0x6004) ? html`<button class="small" @click=${ask(0x6004, null)}>${T.send.position}</button>` : nothing}
        <button class="small" @click=${() => sendLine('nmt start')}>${T.send.start}</button>
        <button class="small primary" @click=${() => (state.tour.value = 0)}>${T.tour.begin}</button>
        ${has(0x1017) ? html`<button class="small" @click=${ask(0x1017, Uint8Array.of(0xe8, 0x03))}>${T.send.heartbeat}</button>` : nothing}
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
    void refiltered.value;
    const kept = state.ring.end - state.ring.first;
    const t = T.frames;
    return html`<div class="frame-area">
      <div class="frame-table" role="table" aria-label=${t.title} aria-rowcount=${kept}>
        <div class="frame-head" role="row">${COLUMNS.map((name) =>
          name === 'delta'
            ? html`<span role="columnheader" class="delta"><button class="head-button" title=${t.gapTitle} @click=${() => (gap.value = gap.value === 'delta' ? 'cycle' : 'delta')}>${gap.value === 'delta' ? t.columns.delta : t.cycle}</button></span>`
            : html`<span role="columnheader" class=${name}>${t.columns[name]}</span>`,
        )}</div>
        <div class="frames scroll" tabindex="0" role="rowgroup" aria-label=${t.rows}></div>
      </div>
      ${kept > 0 && kept < 4 && !state.isBeside.value && paused === null && state.powered.value && !trace.filter ? this.hints() : nothing}
      ${kept === 0 ? html`<p class="frames-empty">${state.real.value ? t.quiet : state.powered.value ? t.empty : t.off}</p>` : trace.count === 0 && trace.filter ? html`<p class="frames-empty">${t.nothing}</p>` : nothing}
      ${this.behind && paused === null ? html`<button class="to-end" @click=${() => this.toEnd()}>${icons.down} ${t.toEnd}</button>` : nothing}
    </div>`;
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    for (const dispose of this.disposers.splice(0)) dispose();
    this.rows?.dispose();
  }
}

/** The bytes; those that differ from the previous frame with this CAN-ID are highlighted. */
function fillData(cell: Element, frame: Frame, fold: Transfer | null | undefined, before: Frame | undefined): void {
  if (frame.disturbed || frame.remote || fold) {
    setText(cell, frame.disturbed ? '' : fold ? T.frames.fold(fold.frames.length, fold.bytes.length) : T.frames.remote);
    return;
  }
  const isOther = (byte: number, i: number): boolean => before !== undefined && !before.remote && before.data[i] !== byte;
  if (!frame.data.some(isOther)) {
    setText(cell, Array.from(frame.data, hexByte).join(' '));
    return;
  }
  cell.replaceChildren();
  frame.data.forEach((byte, i) => {
    if (i) cell.append(' ');
    if (!isOther(byte, i)) cell.append(hexByte(byte));
    else cell.append(Object.assign(document.createElement('mark'), { textContent: hexByte(byte) }));
  });
}

/** A folded transfer in words: the object that was read or written, and its value. */
function foldWords(fold: Transfer | null | undefined, words: string | undefined): string {
  if (!fold) return words ?? '';
  const device = state.devices.peek().find((_, number) => state.statuses.peek()[number]?.nodeId === fold.node);
  const object = device?.objects.find(({ index, sub }) => index === fold.index && sub === fold.sub);
  const name = `${address(fold.index, fold.sub)}${object ? ` ${object.parent ? `${object.parent}.` : ''}${object.name}` : ''}`;
  if (fold.state === 'aborted') return words ?? '';
  const value = object ? showValue(decode(fold.bytes, object), object) : Array.from(fold.bytes.subarray(0, 32), hexByte).join(' ');
  return `${fold.isWrite ? T.frames.write : T.frames.read} ${name}${fold.state === 'done' ? ` = ${value}` : ' …'}`;
}

/** A time difference in as few characters as possible. */
export function delta(micros: number): string {
  if (micros < 1000) return `${Math.round(micros)} µs`;
  if (micros < 1e6) return `${(micros / 1000).toFixed(micros < 1e5 ? 2 : 1)} ms`;
  return `${(micros / 1e6).toFixed(2)} s`;
}

customElements.define('od-frames', FrameList);
