// Frames to send repeatedly: by a click, or cyclically. The list is stored.

import { html, nothing } from 'lit';
import { effect, signal } from '@preact/signals-core';
import { readTyped } from '../actions';
import { act } from '../sim/link';
import * as state from '../state';
import { T } from '../texts';
import { icons } from './icons';
import { View } from './view';

interface Item {
  key: number;
  text: string;
  /** Its period in milliseconds. */
  every: number;
  isOn: boolean;
}

const KEPT = 'odkit.send-list';
const MOST = 50;

const load = (): Item[] => {
  try {
    const kept = JSON.parse(localStorage.getItem(KEPT) ?? '[]') as { text?: unknown; every?: unknown }[];
    return kept.slice(0, MOST).map(({ text, every }, key) => ({ key, text: String(text ?? ''), every: Number(every) || 100, isOn: false }));
  } catch {
    return [];
  }
};

const items = signal<Item[]>(load());
const isShown = signal(items.value.length > 0);

function change(next: Item[]): void {
  items.value = next;
  try {
    localStorage.setItem(KEPT, JSON.stringify(next.map(({ text, every }) => ({ text, every }))));
  } catch {
    // Storage is not allowed: the list exists as long as the page.
  }
}

/** Adds a frame to the list. */
export function addToList(text: string): void {
  if (items.value.length >= MOST) return;
  const key = Math.max(-1, ...items.value.map((item) => item.key)) + 1;
  change([...items.value, { key, text, every: 100, isOn: false }]);
  isShown.value = true;
}

function send(item: Item): void {
  const parsed = readTyped(item.text);
  if (!('frame' in parsed)) return;
  const { id, extended, remote, data } = parsed.frame;
  act({ op: 'send', id, data, extended, remote });
}

/** Starts or stops the cyclic transmission of a row. */
function repeat(item: Item, isOn: boolean): void {
  const parsed = readTyped(item.text);
  const frame = 'frame' in parsed ? parsed.frame : null;
  if (!frame && isOn) return;
  act({
    op: 'repeat', key: item.key, id: frame?.id ?? 0, data: frame?.data ?? new Uint8Array(0),
    extended: frame?.extended ?? false, remote: frame?.remote ?? false, micros: isOn ? item.every * 1000 : 0,
  });
  set(item, { isOn });
}

function set(item: Item, change_: Partial<Item>): void {
  change(items.value.map((one) => (one.key === item.key ? { ...one, ...change_ } : one)));
}

// An opened log is listed here.
effect(() => {
  if (state.log.value) isShown.value = true;
});

class SendList extends View {
  protected override render() {
    const t = T.sendList;
    return html`<details class="send-list" ?open=${isShown.value} @toggle=${(event: Event) => (isShown.value = (event.target as HTMLDetailsElement).open)}>
      <summary>${t.title} <span class="muted num">${items.value.length || ''}</span></summary>
      ${state.log.value ? html`<od-player></od-player>` : nothing}
      <ul class="scroll">${items.value.map((item) => this.row(item))}</ul>
      <button class="small quiet" @click=${() => addToList('')}>${icons.plus} ${t.add}</button>
    </details>`;
  }

  private row(item: Item) {
    const t = T.sendList;
    const parsed = item.text.trim() ? readTyped(item.text) : null;
    const error = parsed && 'error' in parsed ? parsed.error : '';
    const isUnready = !parsed || 'error' in parsed;
    return html`<li>
      <input class="num grow" aria-label=${t.what} placeholder=${t.hint} autocomplete="off" spellcheck="false" .value=${item.text} aria-invalid=${error !== ''} title=${error}
        @change=${(event: Event) => { if (item.isOn) repeat(item, false); set(item, { text: (event.target as HTMLInputElement).value }); }}
        @keydown=${(event: KeyboardEvent) => { if (event.key === 'Enter') { set(item, { text: (event.target as HTMLInputElement).value }); send({ ...item, text: (event.target as HTMLInputElement).value }); } }}>
      <button class="small" ?disabled=${isUnready} @click=${() => send(item)}>${t.send}</button>
      <label class="every"><input class="num" type="number" min="1" max="60000" aria-label=${t.every} .value=${String(item.every)}
        @change=${(event: Event) => { const every = Math.max(1, Number((event.target as HTMLInputElement).value) || 100); set(item, { every }); if (item.isOn) repeat({ ...item, every }, true); }}> ms</label>
      <button class="switch" role="switch" aria-checked=${item.isOn} aria-label=${t.cyclic} title=${t.cyclic} ?disabled=${isUnready && !item.isOn} @click=${() => repeat(item, !item.isOn)}><span class="switch-track"><span class="switch-thumb"></span></span></button>
      <button class="icon-button" aria-label=${t.remove} title=${t.remove} @click=${() => { if (item.isOn) repeat(item, false); change(items.value.filter((one) => one.key !== item.key)); }}>${icons.close}</button>
      ${error ? html`<p class="note" data-tone="error">${error}</p>` : nothing}
    </li>`;
  }
}

customElements.define('od-send-list', SendList);
