// The figures of the capture: one row for each CAN-ID (count, periods, last data)
// and one for each SDO client (response times, aborts).

import { html, nothing } from 'lit';
import { effect } from '@preact/signals-core';
import * as state from '../state';
import { reveal, setFilter, trace, view } from '../capture';
import { grouped, hexByte, hexId } from '../format';
import { knownWords, wordsOf } from '../sim/words';
import { T } from '../texts';
import { delta } from '../views/frame-list';
import { View } from '../views/view';
import './style';
import { S } from './texts';

/** Milliseconds between two refreshes. */
const PERIOD = 100;
/** The rows of a table of `Statistics`, each with `width` numbers. */
function* rowsOf(figures: Float64Array, width: number): Generator<number[]> {
  for (let at = 0; at < figures.length; at += width) yield [...figures.subarray(at, at + width)];
}

const time = (micros: number): string => (Number.isNaN(micros) ? '' : delta(micros));

const head = (names: string[], titles: string[]) =>
  html`<thead><tr>${names.map((name, i) => html`<th scope="col" title=${titles[i] || nothing}>${name}</th>`)}</tr></thead>`;

class Identifiers extends View {
  private timer = 0;
  private stopEffect: (() => void) | undefined;
  /** Time of the last change of each byte, by CAN-ID and position. */
  private readonly changedAt = new Map<number, { last: number; at: number[] }>();

  override connectedCallback(): void {
    super.connectedCallback();
    this.stopEffect = effect(() => {
      void state.captured.value;
      void state.cleared.value;
      this.timer ||= window.setTimeout(() => {
        this.timer = 0;
        this.requestUpdate();
      }, PERIOD);
    });
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.stopEffect?.();
  }

  protected override render() {
    trace.follow();
    const shown = [...rowsOf(trace.statistics.ids(), 8)].filter(([key]) => {
      const last = trace.identifiers.get(key!)?.last ?? -1;
      const frame = state.ring.get(last);
      return frame && (!trace.filter || trace.filter.test(frame, knownWords(last)));
    });
    const words = wordsOf(shown.map(([key]) => trace.identifiers.get(key!)!.last));
    return html`<div class="ids scroll" tabindex="0" role="region" aria-label=${T.frames.ids}>
      <table class="ids-table">
        ${head(S.ids.columns, S.ids.titles)}
        <tbody>${shown.map((row, i) => this.row(row, words[i] ?? ''))}</tbody>
      </table>
      ${this.clients()}
    </div>`;
  }

  private row([key = 0, count = 0, cycle = NaN, least = NaN, mean = NaN, most = NaN, jitter = NaN, changed = NaN]: number[], words: string) {
    const one = trace.identifiers.get(key)!;
    const frame = state.ring.get(one.last)!;
    return html`<tr class="frame-id" data-service=${frame.tag.service} @click=${() => { view.value = 'order'; reveal(one.last); }}>
      <td class="num"><b>${hexId(one.id, one.extended)}</b></td><td class="tag"><b>${frame.tag.text}</b></td><td class="num">${grouped(count)}</td>
      <td class="num">${time(cycle)}</td><td class="num muted">${time(least)}</td><td class="num">${time(mean)}</td><td class="num muted">${time(most)}</td><td class="num">${time(jitter)}</td>
      <td class="num muted">${Number.isNaN(changed) ? S.ids.never : (changed / 1e6).toFixed(3)}</td>
      <td class="num">${frame.remote ? T.frames.remote : this.bytes(key, one.last, frame.data, trace.before(one.last)?.data)}</td><td class="words" title=${words}>${words}</td>
    </tr>`;
  }

  /** A click shows the frames of a client. */
  private clients() {
    const rows = [...rowsOf(trace.statistics.clients(), 7)];
    if (rows.length === 0) return nothing;
    return html`<table class="clients" aria-label=${S.ids.clients}>
      <caption>${S.ids.clients}</caption>
      ${head(S.ids.clientColumns, S.ids.clientTitles)}
      <tbody>${rows.map(([node = 0, requests = 0, least = NaN, mean = NaN, most = NaN, aborts = 0, unanswered = 0]) => html`<tr>
        <td class="num"><button class="link" title=${S.ids.only(node)} @click=${() => { setFilter(`node:${node} sdo`); view.value = 'order'; }}>${node}</button></td>
        <td class="num">${grouped(requests)}</td><td class="num muted">${time(least)}</td><td class="num">${time(mean)}</td><td class="num muted">${time(most)}</td>
        <td class="num" ?data-bad=${aborts > 0}>${grouped(aborts)}</td><td class="num" ?data-bad=${unanswered > 0}>${grouped(unanswered)}</td>
      </tr>`)}</tbody>
    </table>`;
  }

  /** The bytes; changed ones are highlighted for a moment. */
  private bytes(key: number, last: number, data: Uint8Array, before: Uint8Array | undefined) {
    const now = performance.now();
    const known = this.changedAt.get(key) ?? { last: -1, at: [] };
    if (known.last !== last) {
      data.forEach((byte, i) => {
        if (before && before[i] !== byte) known.at[i] = now;
      });
      known.last = last;
      this.changedAt.set(key, known);
    }
    return Array.from(data, (byte, i) => {
      const age = now - (known.at[i] ?? -Infinity);
      return html`<span class="id-byte" style=${age < 1500 ? `--fresh: ${(1 - age / 1500).toFixed(2)}` : ''}>${hexByte(byte)}</span>`;
    });
  }
}

customElements.define('od-identifiers', Identifiers);
