// The nodes of the bus, from the frames of the capture: state, heartbeat, last EMCY. The same for the virtual bench, a real bus and a log.

import { html, nothing } from 'lit';
import { effect } from '@preact/signals-core';
import * as state from '../state';
import { reveal, setFilter, view } from '../capture';
import { select } from '../sim/link';
import { wordsOf } from '../sim/words';
import { T } from '../texts';
import { isLate, Nodes, type Seen } from '../trace/nodes';
import { View } from '../views/view';
import { beside } from './shelf';
import './style';
import { S } from './texts';

/** Milliseconds between two refreshes. */
const PERIOD = 200;

const seconds = (micros: number): string => (micros / 1e6).toFixed(1);

class NodeList extends View {
  private timer = 0;
  private stopEffect: (() => void) | undefined;
  private readonly nodes = new Nodes(state.ring);
  private shown = -1;

  override connectedCallback(): void {
    super.connectedCallback();
    this.stopEffect = effect(() => {
      void state.now.value;
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

  /** The time to which ages refer: the last frame of a log, or the present. */
  private get now(): number {
    const { ring } = state;
    return beside.value?.isShown ? (ring.get(ring.end - 1)?.time ?? 0) : state.now.peek();
  }

  /** The device of the bench with this node ID, or the device profile that 1000h names. */
  private device(one: Seen) {
    const at = beside.value?.isShown ? -1 : state.statuses.peek().findIndex(({ nodeId }) => nodeId === one.node);
    const device = state.devices.peek()[at];
    if (device) return html`<button class="link" title=${device.title} @click=${() => select(at)}>${device.name}</button>`;
    return one.type === null ? html`<span class="muted">${S.nodes.unread}</span>` : S.nodes.profile(one.type & 0xffff);
  }

  private row(one: Seen, now: number, words: string | undefined) {
    const t = S.nodes;
    const late = isLate(one, now);
    return html`<tr>
      <td class="num"><button class="link" title=${t.only(one.node)} @click=${() => { setFilter(`node:${one.node}`); view.value = 'order'; }}>${one.node}</button></td>
      <td>${this.device(one)}</td>
      <td><span class="pill" data-nmt=${one.state} title=${one.isOrdered ? t.ordered : ''}>${T.encoder.states[one.state]}${one.isOrdered ? ' ?' : ''}</span></td>
      <td ?data-bad=${late}>${one.heartbeat === null ? html`<span class="muted">${t.noHeartbeat}</span>` : t.heartbeat(seconds(now - one.heartbeat), one.period === null ? null : seconds(one.period))}${late ? html` <b>${t.late}</b>` : nothing}</td>
      <td>${one.emcy ? html`<button class="link" ?data-bad=${one.emcy.code !== 0} @click=${() => { view.value = 'order'; reveal(one.emcy!.number); }}>${words?.replace(/^[^:]*: /, '') ?? `${one.emcy.code.toString(16).toUpperCase().padStart(4, '0')}h`}</button>` : html`<span class="muted">${t.noEmcy}</span>`}</td>
      <td>${t.ago(seconds(now - one.at))}</td>
    </tr>`;
  }

  protected override render() {
    const t = S.nodes;
    // Numbers of frames repeat after a step back, and in a log.
    if (this.shown !== state.cleared.value) this.nodes.restart();
    this.shown = state.cleared.value;
    this.nodes.follow();
    const { all } = this.nodes;
    const { now } = this;
    const words = wordsOf(all.map((one) => one.emcy?.number ?? -1));
    return html`<div class="ids node-list scroll" tabindex="0" role="region" aria-label=${T.frames.nodes}>
      ${all.length === 0
        ? html`<p class="note">${t.none}</p>`
        : html`<table><thead><tr>${t.columns.map((name) => html`<th scope="col">${name}</th>`)}</tr></thead><tbody>${all.map((one, i) => this.row(one, now, words[i]))}</tbody></table>`}
    </div>`;
  }
}

customElements.define('od-node-list', NodeList);
