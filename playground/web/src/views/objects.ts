// The object dictionary with live values. Reading them puts nothing on the bus.

import { html, nothing } from 'lit';
import { effect } from '@preact/signals-core';
import type { ObjectRecord } from '../sim/api';
import { address, hexIndex, otherSpelling, range, sameValue, showValue } from '../can/values';
import { watch } from '../sim/link';
import * as state from '../state';
import { icons } from './icons';
import { findObjects } from './object-search';
import { Rows, setText } from './rows';
import { View } from './view';

/** A row is an object, or the heading of a record. */
type Line = { object: ObjectRecord; heading: false } | { heading: true; index: number; name: string };

class Objects extends View {
  static override properties = { query: { state: true } };
  declare query: string;
  private lines: Line[] = [];
  private rows: Rows | undefined;
  private watched = '';
  private disposers: (() => void)[] = [];

  constructor() {
    super();
    this.query = '';
  }

  private rebuild(): void {
    const found = findObjects(state.device.value?.objects ?? [], this.query);
    this.lines = [];
    let heading = -1;
    for (const object of found) {
      if (object.parent !== null && object.index !== heading) {
        heading = object.index;
        this.lines.push({ heading: true, index: object.index, name: object.parent });
      }
      this.lines.push({ object, heading: false });
    }
    this.watched = '';
    this.rows?.draw();
    const chosen = this.lines.findIndex((line) => !line.heading && line.object === state.selected.peek());
    if (chosen >= 0) this.rows?.reveal(chosen);
    this.rows?.redraw();
  }

  protected override firstUpdated(): void {
    const viewport = this.querySelector<HTMLElement>('.object-rows')!;
    this.rows = new Rows(viewport, {
      count: () => this.lines.length,
      make: () => {
        const row = document.createElement('div');
        row.setAttribute('role', 'option');
        row.innerHTML = '<span class="index"></span><span class="name"></span><span class="access"></span><span class="value"></span>';
        row.addEventListener('click', () => this.onRow(Number(row.dataset['line'])));
        return row;
      },
      fill: (row, index) => this.fill(row, index),
      filled: (from, to) => this.watchLines(from, to),
    });
    viewport.addEventListener('keydown', (event) => this.onKey(event));
    this.disposers.push(
      effect(() => {
        void state.device.value;
        viewport.scrollTop = 0;
        this.rebuild();
      }),
      effect(() => {
        void state.values.value;
        void state.selected.value;
        this.rows?.redraw();
      }),
      effect(() => {
        if (state.tab.value === 'objects') this.rows?.redraw();
      }),
    );
  }

  private fill(row: HTMLElement, index: number): void {
    const line = this.lines[index];
    if (!line) return;
    row.dataset['line'] = String(index);
    row.className = line.heading ? 'row object heading' : line.object.parent === null ? 'row object' : 'row object member';
    const [where, name, access, value] = row.children;
    if (line.heading) {
      setText(where, hexIndex(line.index));
      setText(name, line.name);
      setText(access, '');
      setText(value, '');
      row.removeAttribute('data-changed');
      row.setAttribute('aria-selected', 'false');
      return;
    }
    const { object } = line;
    const key = state.keyOf(object.index, object.sub);
    const live = state.values.peek().get(key);
    setText(where, object.parent === null ? hexIndex(object.index) : `:${object.sub.toString(16).toUpperCase().padStart(2, '0')}`);
    setText(name, object.name);
    setText(access, object.access);
    setText(value, live === undefined ? '' : showValue(live, object));
    row.title = `${address(object.index, object.sub, true)} ${object.name}`;
    row.toggleAttribute('data-changed', live !== undefined && isChanged(object, live));
    row.setAttribute('aria-selected', String(state.selected.peek() === object));
  }

  /** Only what is on screen is read again and again. */
  private watchLines(from: number, to: number): void {
    const objects = this.lines.slice(from, to).flatMap((line) => (line.heading ? [] : [line.object]));
    const chosen = state.selected.peek();
    if (chosen && !objects.includes(chosen)) objects.push(chosen);
    const addresses = objects.map(({ index, sub }) => ({ index, sub }));
    const text = JSON.stringify(addresses);
    if (text === this.watched) return;
    this.watched = text;
    watch(addresses);
  }

  private onRow(index: number): void {
    const line = this.lines[index];
    if (line && !line.heading) state.selected.value = line.object;
  }

  private onKey(event: KeyboardEvent): void {
    const move = { ArrowDown: 1, ArrowUp: -1, PageDown: 10, PageUp: -10 }[event.key];
    if (!move) return;
    event.preventDefault();
    const chosen = this.lines.findIndex((line) => !line.heading && line.object === state.selected.value);
    let next = Math.max(0, Math.min(this.lines.length - 1, chosen + move));
    while (this.lines[next]?.heading) next += Math.sign(move);
    const line = this.lines[next];
    if (!line || line.heading) return;
    state.selected.value = line.object;
    this.rows?.reveal(next);
  }

  protected override render() {
    const total = state.device.value?.objects.length ?? 0;
    return html`
      <header class="panel-head">
        <h2>Object dictionary</h2>
        <span class="muted num count">${total}</span>
        <div class="spacer"></div>
        <label class="search">${icons.search}<input type="search" placeholder="Index or name" aria-label="Search objects" autocomplete="off" spellcheck="false"
          .value=${this.query} @input=${(event: Event) => { this.query = (event.target as HTMLInputElement).value; this.rebuild(); }}></label>
      </header>
      <div class="object-rows scroll" role="listbox" tabindex="0" aria-label="Objects with their live values"></div>
      <od-object-detail></od-object-detail>
    `;
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    for (const dispose of this.disposers.splice(0)) dispose();
    this.rows?.dispose();
  }
}

/** Something that a master set: what the device itself changes is no mark. */
function isChanged(object: ObjectRecord, live: unknown): boolean {
  return object.access.startsWith('rw') && object.default !== null && live !== null && !sameValue(live as never, object.default);
}

/** The chosen object: everything that its EDS says. */
class ObjectDetail extends View {
  protected override render() {
    const object = state.selected.value;
    if (!object) return nothing;
    const live = state.values.value.get(state.keyOf(object.index, object.sub)) ?? null;
    const limits = range(object);
    const other = otherSpelling(live, object);
    return html`<div class="detail">
      <div class="detail-head">
        <strong><span class="num">${address(object.index, object.sub, object.parent !== null)}</span> ${object.name}</strong>
        <div class="spacer"></div>
        <button class="small tabs-only" @click=${() => (state.tab.value = 'console')}>${icons.console} Read or write</button>
        <button class="icon-button" aria-label="Close the details" @click=${() => (state.selected.value = null)}>${icons.close}</button>
      </div>
      <dl>
        <div class="whole"><dt>Value</dt><dd class="num" aria-label="Value of the chosen object">${showValue(live, object)}${other ? html` <span class="muted">${other}</span>` : nothing}</dd></div>
        <div><dt>Type</dt><dd>${object.type}</dd></div>
        <div><dt>Access</dt><dd>${object.access}${object.mappable ? ', PDO' : ''}</dd></div>
        <div><dt>Default</dt><dd class="num">${showValue(object.default, object)}</dd></div>
        <div><dt>Range</dt><dd class="num">${limits ? `${showValue(limits.low, object)} … ${showValue(limits.high, object)}` : '–'}</dd></div>
      </dl>
    </div>`;
  }
}

customElements.define('od-object-detail', ObjectDetail);
customElements.define('od-objects', Objects);
