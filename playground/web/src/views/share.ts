// Shares the bench: a link, a file, a frame in another page.

import { html, nothing, type PropertyValues } from 'lit';
import { effect } from '@preact/signals-core';
import { copyText } from '../clipboard';
import { sheet } from '../sheet';
import * as state from '../state';
import { T } from '../texts';
import { write } from '../share/bench';
import { before, when } from '../share/keep';
import { hashOf, now, openText } from '../share/make';
import { icons } from './icons';
import { D } from './texts';
import { View } from './view';

await sheet('dialogs');

/** Maximum length of an address that every mail program and chat transmits completely. */
const LONG = 8000;
/** Maximum size of a file. */
const LONGEST = 20_000_000;

class Share extends View {
  static override properties = { trace: { state: true }, link: { state: true }, isShort: { state: true }, copied: { state: true }, earlier: { state: true } };
  declare trace: boolean;
  declare link: string;
  declare isShort: boolean;
  declare copied: '' | 'link' | 'frame';
  declare earlier: { at: number; names: string[]; text: string } | null;
  private unopen: (() => void) | undefined;

  constructor() {
    super();
    this.trace = false;
    this.link = '';
    this.isShort = false;
    this.copied = '';
    this.earlier = null;
  }

  protected override firstUpdated(changed: PropertyValues): void {
    super.firstUpdated(changed);
    const dialog = this.querySelector('dialog')!;
    this.unopen = effect(() => {
      if (state.shareDialog.value && !dialog.open) {
        dialog.showModal();
        void this.make();
        void before().then((kept) => (this.earlier = kept ?? null));
      } else if (!state.shareDialog.value && dialog.open) {
        dialog.close();
      }
    });
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.unopen?.();
  }

  private async make(): Promise<void> {
    this.copied = '';
    const bench = await now(this.trace);
    this.isShort = bench.trace === this.trace;
    const address = new URL(location.href);
    address.search = '';
    address.hash = await hashOf(bench);
    this.link = address.href;
  }

  private get frame(): string {
    const address = new URL(this.link || location.href);
    address.search = '?embed';
    return `<iframe src="${address.href}" width="100%" height="640" title="${D.share.frameTitle}" loading="lazy"></iframe>`;
  }

  private async copy(what: 'link' | 'frame'): Promise<void> {
    const field = this.querySelector<HTMLInputElement>(`#share-${what}`)!;
    if (await copyText(field.value)) this.copied = what;
    // The text is selected, so that the user can copy it.
    else field.select();
  }

  private async save(): Promise<void> {
    const text = write(await now(this.trace));
    const url = URL.createObjectURL(new Blob([text], { type: 'application/json' }));
    const link = document.createElement('a');
    link.href = url;
    link.download = `odkit-${state.devices.value.map((one) => one.name).join('-').replace(/[^\w.-]+/g, '_')}.json`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(url), 1000);
  }

  private async openFile(event: Event): Promise<void> {
    const field = event.target as HTMLInputElement;
    const file = field.files?.[0];
    if (!file) return;
    const isOpen = file.size <= LONGEST && (await openText(await file.text(), file.name));
    field.value = '';
    if (isOpen) this.close();
    else if (file.size > LONGEST) state.toast.value = { text: D.share.badFile(file.name, D.share.tooLarge), tone: 'error' };
  }

  private close(): void {
    state.shareDialog.value = false;
  }

  private field(what: 'link' | 'frame', label: string, value: string) {
    return html`<div class="share-field">
      <label for=${`share-${what}`}>${label}</label>
      <input id=${`share-${what}`} class="num" readonly .value=${value} @focus=${(event: Event) => (event.target as HTMLInputElement).select()}>
      <button ?disabled=${!value} aria-label=${D.share.copyThe(label)} @click=${() => this.copy(what)}>${this.copied === what ? D.share.copied : D.share.copy}</button>
    </div>`;
  }

  protected override render() {
    const t = D.share;
    const choice = (trace: boolean, text: string, hint: string) => html`<label class="choice">
      <input type="radio" name="share-trace" .checked=${this.trace === trace} @change=${() => { this.trace = trace; void this.make(); }}>
      <span><strong>${text}</strong><span class="muted">${hint}</span></span>
    </label>`;
    return html`<dialog class="dialog" aria-labelledby="share-title" @close=${() => this.close()}
      @click=${(event: Event) => { if (event.target === event.currentTarget) this.close(); }}>
      <div class="dialog-body">
        <header class="dialog-head">
          <h2 id="share-title">${t.title}</h2>
          <button class="icon-button" aria-label=${T.close} @click=${() => this.close()}>${icons.close}</button>
        </header>
        <fieldset class="choices"><legend class="sr">${t.what}</legend>
          ${choice(false, t.without, t.withoutHint)}
          ${choice(true, t.with, t.withHint(state.journal.entries.length))}
        </fieldset>
        ${this.field('link', t.link, this.link)}
        <p class="note" role="status" data-tone=${this.link.length > LONG ? 'error' : ''}>${this.link.length > LONG ? t.long(this.link.length) : this.link && !this.isShort ? t.onlyWith : this.link ? t.length(this.link.length) : t.making}</p>
        ${this.field('frame', t.frame, this.link ? this.frame : '')}
        <div class="dialog-foot share-files">
          <button @click=${() => this.save()}>${icons.save} ${t.save}</button>
          <label class="button">${icons.file} ${t.open}<input class="sr" type="file" accept=".json,application/json" aria-label=${t.file} @change=${(event: Event) => this.openFile(event)}></label>
          ${this.earlier
            ? html`<button title=${t.earlierHint} @click=${() => { const kept = this.earlier!; this.close(); void openText(kept.text, t.keptName); }}>${t.earlier(this.earlier.names.join(', '), when(this.earlier.at))}</button>`
            : nothing}
        </div>
      </div>
    </dialog>`;
  }
}

customElements.define('od-share', Share);
