// The object dictionary with live values, which are read without using the bus.

import { html } from 'lit';
import { effect } from '@preact/signals-core';
import { download } from '../actions';
import type { ObjectRecord, Value } from '../sim/api';
import { address, hexIndex, sameValue, showValue } from '../format';
import { askEach, exportDcf, watch } from '../sim/link';
import * as state from '../state';
import { T } from '../texts';
import { besideSwitch } from './beside';
import { icons } from './icons';
import { findObjects } from './object-search';
import { cells, Rows, setText } from './rows';
import { openMapping } from './object-detail';
import { View } from './view';

/** Number of characters from which a name takes two small lines. */
const LONG = 17;

/** Which objects the list shows. */
type Show = 'all' | 'changed' | 'unsaved';

/** A row is an object, or the heading of a record. */
type Line = { object: ObjectRecord; heading: false } | { heading: true; index: number; name: string };

class Objects extends View {
  static override properties = { query: { state: true }, show: { state: true } };
  declare query: string;
  declare show: Show;
  /** Objects that differ from the factory values, at the last check. */
  private changed: ReadonlySet<number> = new Set();
  private timer = 0;
  private lines: Line[] = [];
  private rows: Rows | undefined;
  private watched = '';
  private disposers: (() => void)[] = [];

  constructor() {
    super();
    this.query = '';
    this.show = 'all';
  }

  private rebuild(): void {
    const wanted = this.show === 'changed' ? this.changed : this.show === 'unsaved' ? state.unsaved.peek() : null;
    const objects = (state.device.value?.objects ?? []).filter(({ index, sub }) => !wanted || wanted.has(state.keyOf(index, sub)));
    const found = findObjects(objects, this.query);
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
        row.append(...cells(['index', 'name', 'access', 'mark', 'value']));
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
        void state.unsaved.value;
        if (this.show === 'unsaved') this.rebuild();
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
    const [where, name, access, mark, value] = row.children;
    if (line.heading) {
      setText(where, hexIndex(line.index));
      setText(name, line.name);
      row.removeAttribute('data-long');
      setText(access, '');
      setText(value, '');
      setText(mark, '');
      row.removeAttribute('data-changed');
      row.setAttribute('aria-selected', 'false');
      return;
    }
    const { object } = line;
    const key = state.keyOf(object.index, object.sub);
    const live = state.values.peek().get(key);
    setText(where, object.parent === null ? hexIndex(object.index) : `:${object.sub.toString(16).toUpperCase().padStart(2, '0')}`);
    setText(name, object.name);
    row.toggleAttribute('data-long', object.name.length > LONG);
    setText(access, object.access);
    setText(value, live === undefined ? '' : showValue(live, object));
    const kind = live === undefined ? '' : markOf(object, live);
    setText(mark, kind === 'ram' || kind === 'eeprom' ? T.objects.mark[kind] : '');
    row.title = `${address(object.index, object.sub, true)} ${object.name}${kind ? `\n${T.objects.markTitle[kind]}` : ''}`;
    row.dataset['mark'] = kind;
    row.toggleAttribute('data-changed', kind !== '');
    row.setAttribute('aria-selected', String(state.selected.peek() === object));
  }

  /** Only visible values are read repeatedly. */
  private watchLines(from: number, to: number): void {
    const objects = this.lines.slice(from, to).flatMap((line) => (line.heading ? [] : [line.object]));
    const chosen = state.selected.peek();
    if (chosen && !objects.includes(chosen)) objects.push(chosen);
    const addresses = objects.map(({ index, sub }) => ({ index, sub }));
    const text = JSON.stringify([addresses, chosen?.index, chosen?.sub]);
    if (text === this.watched) return;
    this.watched = text;
    watch(addresses, chosen ? { index: chosen.index, sub: chosen.sub } : null);
  }

  private onRow(index: number): void {
    const line = this.lines[index];
    if (line && !line.heading) state.selected.value = line.object;
  }

  private onKey(event: KeyboardEvent): void {
    if (event.key === 'Enter') this.querySelector<HTMLElement>('.detail-form input')?.focus();
    if (event.key === 'Escape') state.selected.value = null;
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

  private choose(show: Show): void {
    this.show = show;
    clearInterval(this.timer);
    if (show === 'changed') {
      void this.lookAtAll();
      this.timer = window.setInterval(() => void this.lookAtAll(), 1000);
    }
    this.rebuild();
  }

  /** Objects that differ from the factory values: all are read once a second while the list shows only these. */
  private async lookAtAll(): Promise<void> {
    const objects = (state.device.peek()?.objects ?? []).filter((object) => object.access.startsWith('rw') && object.default !== null);
    const node = state.selectedNode.peek();
    const values = await askEach('read', objects.map(({ index, sub }) => [node, index, sub]));
    const changed = objects.filter((object, i) => isChanged(object, values[i] ?? null)).map(({ index, sub }) => state.keyOf(index, sub));
    if (changed.length === this.changed.size && changed.every((key) => this.changed.has(key))) return;
    this.changed = new Set(changed);
    if (this.show === 'changed') this.rebuild();
  }

  private async saveDcf(): Promise<void> {
    const text = await exportDcf(state.selectedNode.value);
    if (text === null) state.toast.value = { text: T.objects.noDcf, tone: 'error' };
    else download(text, `${(state.device.value?.name ?? 'device').replace(/[^\w.-]+/g, '_')}-node${state.nodeId.value}.dcf`);
  }

  protected override render() {
    const total = state.device.value?.objects.length ?? 0;
    const hasMapping = (state.device.value?.objects ?? []).some(({ isMapping }) => isMapping);
    const t = T.objects;
    const choice = (show: Show, text: string) => html`<label class="segment"><input type="radio" name="objects-show" .checked=${this.show === show} @change=${() => this.choose(show)}><span>${text}</span></label>`;
    return html`
      <header class="panel-head">
        <h2>${t.title}</h2>
        <span class="muted num count">${total}</span>
        <div class="spacer"></div>
        ${besideSwitch()}
        <label class="search">${icons.search}<input type="search" placeholder=${t.hint} aria-label=${t.search} autocomplete="off" spellcheck="false"
          .value=${this.query} @input=${(event: Event) => { this.query = (event.target as HTMLInputElement).value; this.rebuild(); }}></label>
      </header>
      <div class="object-tools">
        <div class="segments" role="radiogroup" aria-label=${t.show}>
          ${choice('all', t.all)}${choice('changed', t.changed)}${choice('unsaved', t.unsaved)}
        </div>
        <div class="spacer"></div>
        <button class="small" title=${t.mappingTitle} aria-haspopup="dialog" ?hidden=${!hasMapping} aria-label=${t.mapping} @click=${() => openMapping(0)}>${t.mappingShort}</button>
        <button class="small" title=${t.dcfTitle} aria-label=${t.dcf} @click=${() => this.saveDcf()}>${icons.save} ${t.dcfShort}</button>
      </div>
      <div class="object-rows scroll" role="listbox" tabindex="0" aria-label=${t.list}></div>
      <od-object-detail></od-object-detail>
    `;
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    clearInterval(this.timer);
    for (const dispose of this.disposers.splice(0)) dispose();
    this.rows?.dispose();
  }
}

/** Returns whether a master changed the object: changes by the device itself are not marked. */
function isChanged(object: ObjectRecord, live: Value): boolean {
  return object.access.startsWith('rw') && object.default !== null && live !== null && !sameValue(live, object.default);
}

/** Memory of a changed value: RAM only, saved as well, or not saved by this device. */
function markOf(object: ObjectRecord, live: Value): '' | 'ram' | 'eeprom' | 'set' {
  if (state.unsaved.peek().has(state.keyOf(object.index, object.sub))) return 'ram';
  if (!isChanged(object, live)) return '';
  return object.isSaved ? 'eeprom' : 'set';
}

customElements.define('od-objects', Objects);
