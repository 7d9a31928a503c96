// Shown in place of the virtual encoder: the selected real node, and the nodes of its bus.

import { html, nothing } from 'lit';
import { effect } from '@preact/signals-core';
import * as state from '../state';
import { sendLine } from '../actions';
import { select } from '../sim/link';
import { T } from '../texts';
import { R } from './texts';
import { icons } from '../views/icons';
import { View } from '../views/view';
import { answered, doing, isBusy, readAll, search, show, stop } from './nodes';

class Node extends View {
  private node() {
    const device = state.device.value;
    const status = state.status.value;
    if (!device || !status) return nothing;
    return html`<section class="real-part">
      <p><strong>${device.name}</strong> <span class="badge">${T.topbar.nodeBadge(status.nodeId)}</span></p>
      <p class="note">${R.description} ${device.source.kind === 'eds' ? device.source.name : device.title}. ${R.valuesHint}</p>
      <div class="real-row">
        <button class="small" ?disabled=${isBusy.value} @click=${() => void readAll()}>${R.readAll}</button>
        <button class="small" aria-haspopup="dialog" @click=${() => (state.deviceDialog.value = state.selectedNode.value)}>${R.changeDescription}</button>
      </div>
    </section>`;
  }

  protected override render() {
    const nmt = state.nmt.value;
    const hasNode = state.device.value !== null;
    return html`<header class="panel-head">
        <h2>${R.panel}</h2>
        ${hasNode ? html`<span class="pill" data-nmt=${nmt} role="status" aria-label=${T.encoder.nmt} title=${nmt === 'unknown' ? R.never : ''}>${T.encoder.states[nmt]}</span>` : nothing}
        <div class="spacer"></div>
        ${hasNode ? html`<button class="small" aria-label=${T.encoder.resetLabel} title=${T.encoder.resetTitle} @click=${() => sendLine('nmt reset')}>${icons.reset} ${T.encoder.reset}</button>` : nothing}
      </header>
      <div class="real-body scroll">${this.node()}<od-real-nodes></od-real-nodes></div>`;
  }
}

/** The nodes on the bus. */
class Nodes extends View {
  protected override render() {
    const shown = new Map(state.statuses.value.map(({ nodeId }, number) => [nodeId, number]));
    const nodes = [...new Set([...(state.real.value?.nodes ?? []), ...answered.value])].sort((a, b) => a - b);
    return html`<section class="real-part">
      <h3>${R.nodes}</h3>
      ${nodes.length
        ? html`<ul class="real-nodes">${nodes.map((node) => {
            const at = shown.get(node);
            return html`<li><span>${R.node(node)}${at === undefined ? nothing : html` <span class="muted">${state.devices.value[at]?.name}</span>`}</span>
              <button class="small" ?disabled=${at === undefined && isBusy.value} aria-pressed=${at !== undefined && at === state.selectedNode.value} aria-label=${`${R.show} ${R.node(node)}`} @click=${() => (at === undefined ? void show(node) : select(at))}>${R.show}</button></li>`;
          })}</ul>`
        : html`<p class="note">${R.noNodes}</p>`}
      <div class="real-row">
        ${isBusy.value ? html`<button class="small" @click=${stop}>${R.stop}</button>` : html`<button class="small" title=${R.scanTitle} @click=${() => void search()}>${R.scan}</button>`}
        <span class="note" role="status">${doing.value}</span>
      </div>
    </section>`;
  }
}

/** In the device dialog: the kind of the device. */
class Kind extends View {
  protected override render() {
    const choice = (describes: boolean, text: string) => html`<label class="choice"><input type="radio" name="real-kind" .checked=${state.describes.value === describes} @change=${() => (state.describes.value = describes)}> <span>${text}</span></label>`;
    return html`<div role="radiogroup" aria-label=${R.kindOf}>${choice(true, R.describes)}${choice(false, R.virtual)}</div>`;
  }
}

customElements.define('od-real-kind', Kind);

// Controls of virtual devices are hidden.
effect(() => {
  document.documentElement.toggleAttribute('data-real-node', state.real.value !== null && state.status.value?.real !== false);
});

customElements.define('od-real-nodes', Nodes);
customElements.define('od-real-node', Node);
