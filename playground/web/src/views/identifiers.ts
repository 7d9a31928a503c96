// One row for each identifier: how often it came, in what rhythm, and what it said last.

import { html } from 'lit';
import { effect } from '@preact/signals-core';
import * as state from '../state';
import { reveal, trace, view } from '../capture';
import { hexByte, hexId } from '../format';
import { grouped } from '../format';
import { knownWords, wordsOf } from '../sim/words';
import { T } from '../texts';
import { delta } from './frame-list';
import { View } from './view';

/** Milliseconds between two drawings. */
const PERIOD = 100;

class Identifiers extends View {
  private timer = 0;
  private stopEffect: (() => void) | undefined;
  /** When a byte of an identifier changed last, by key and place. */
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
    const list = [...trace.identifiers.values()].sort((a, b) => a.key - b.key);
    const shown = list.filter(({ last }) => {
      const frame = state.ring.get(last);
      return frame && (!trace.filter || trace.filter.test(frame, knownWords(last)));
    });
    const words = wordsOf(shown.map(({ last }) => last));
    return html`<div class="ids scroll" tabindex="0" role="region" aria-label=${T.frames.ids}>
      <table>
        <thead><tr>${T.frames.idColumns.map((name) => html`<th scope="col">${name}</th>`)}</tr></thead>
        <tbody>${shown.map((one, i) => {
          const frame = state.ring.get(one.last)!;
          const tag = frame.tag;
          return html`<tr class="frame-id" data-service=${tag.service} @click=${() => { view.value = 'order'; reveal(one.last); }}>
            <td class="num"><b>${hexId(one.id, one.extended)}</b></td><td class="tag"><b>${tag.text}</b></td><td class="num">${grouped(one.count)}</td>
            <td class="num">${one.count > 1 ? delta(one.cycle) : ''}</td><td class="num muted">${one.count > 1 ? delta(one.least) : ''}</td><td class="num muted">${one.count > 1 ? delta(one.most) : ''}</td>
            <td class="num">${frame.remote ? T.frames.remote : this.bytes(one.key, one.last, frame.data, trace.before(one.last)?.data)}</td><td class="words" title=${words[i] ?? ''}>${words[i] ?? ''}</td>
          </tr>`;
        })}</tbody>
      </table>
    </div>`;
  }

  /** The bytes; those that changed stand out for a while. */
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
