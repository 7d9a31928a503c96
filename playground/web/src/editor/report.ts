// The report of an opened file: what happened to it, and its findings, errors first.

import { html, nothing, type PropertyValues } from 'lit';
import { effect } from '@preact/signals-core';
import { undoReplace } from '../actions';
import { sheet } from '../sheet';
import * as state from '../state';
import { T } from '../texts';
import { E } from './texts';
import { icons } from '../views/icons';
import { View } from '../views/view';
import type { Finding, Found } from './api';
import { ask, listen, send, uriOf } from './client';
import { FindingList } from './list';
import { openText } from './open';

class Report extends View {
  static override properties = { found: { state: true }, isStyled: { state: true } };
  declare found: Found | null;
  declare isStyled: boolean;
  private list: FindingList | undefined;
  private unfollow: (() => void) | undefined;
  private uri = '';

  constructor() {
    super();
    this.found = null;
    this.isStyled = false;
    void sheet('editing').then(() => (this.isStyled = true));
  }

  protected override firstUpdated(changed: PropertyValues): void {
    super.firstUpdated(changed);
    this.unfollow = effect(() => this.follow(state.report.value));
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.unfollow?.();
  }

  /** Sets another file; its findings come from the language server. */
  private follow(opened: state.Opened | null): void {
    if (this.uri) send({ op: 'close', uri: this.uri });
    this.list?.dispose();
    this.list = undefined;
    this.found = null;
    this.uri = '';
    if (!opened?.device) return;
    const { name, text, bytes } = opened.device;
    const uri = (this.uri = uriOf(name));
    const unlisten = listen(uri, (found) => {
      unlisten();
      if (uri === this.uri) this.found = found;
    });
    ask('open', uri, bytes ? { bytes } : { text }).catch((error: unknown) => (state.toast.value = { text: String(error), tone: 'error' }));
  }

  protected override updated(): void {
    const viewport = this.querySelector<HTMLElement>('.found');
    if (!viewport || !this.found || this.list) return;
    this.list = new FindingList(viewport, this.uri, (finding) => this.edit(finding));
    this.list.show(this.found);
  }

  private edit(finding: Finding | null): void {
    const device = state.report.value?.device;
    if (device) state.editing.value = { ...device, at: finding?.range.start ?? null };
  }

  protected override render() {
    const opened = state.report.value;
    if (!opened || !this.isStyled) return nothing;
    const { device, action } = opened;
    const close = (): void => void (state.report.value = null);
    const { found } = this;
    const total = found ? found.counts.error + found.counts.warning + found.counts.info : 0;
    return html`<section class="report" role=${opened.isBad ? 'alert' : 'region'} aria-label=${E.report.label} data-bad=${opened.isBad}
      @keydown=${(event: KeyboardEvent) => event.key === 'Escape' && close()}>
      <header role="none">
        <h3>${opened.said}</h3>
        ${device ? html`<span class="muted">${found ? (total ? E.counts(found.counts.error, found.counts.warning, found.counts.info) : E.report.clean) : E.checking}</span>` : nothing}
        <div class="spacer"></div>
        ${action ? html`<button class="small" @click=${() => { close(); action.run(); }}>${action.text}</button>` : nothing}
        ${device && opened.isBad ? html`<button class="small" title=${T.dialog.anywayTitle} @click=${() => void openText(device, true)}>${T.dialog.anyway}</button>` : nothing}
        ${device ? html`<button class="small" @click=${() => this.edit(null)}>${E.report.edit}</button>` : nothing}
        ${!opened.isBad && state.replaced.value ? html`<button class="small" @click=${() => void undoReplace()}>${T.dialog.undo(state.replaced.value.name)}</button>` : nothing}
        <button class="icon-button" aria-label=${E.report.close} title=${E.report.close} @click=${close}>${icons.close}</button>
      </header>
      ${total ? html`<div class="found scroll" tabindex="0" role="group" aria-label=${E.report.list}></div>` : nothing}
    </section>`;
  }
}

customElements.define('od-report', Report);
