// The list of keys.

import { html } from 'lit';
import { effect } from '@preact/signals-core';
import { sheet } from '../sheet';
import * as state from '../state';
import { T } from '../texts';
import { icons } from './icons';
import { D } from './texts';
import { View } from './view';

await sheet('dialogs');

class Help extends View {
  private unopen: (() => void) | undefined;

  protected override firstUpdated(): void {
    const dialog = this.querySelector('dialog')!;
    this.unopen = effect(() => {
      if (state.helpDialog.value && !dialog.open) dialog.showModal();
      else if (!state.helpDialog.value && dialog.open) dialog.close();
    });
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.unopen?.();
  }

  protected override render() {
    const close = (): void => void (state.helpDialog.value = false);
    return html`<dialog class="dialog" aria-labelledby="help-title" @close=${close} @click=${(event: Event) => event.target === event.currentTarget && close()}>
      <div class="dialog-body">
        <header class="dialog-head">
          <h2 id="help-title">${D.help.title}</h2>
          <button class="icon-button" aria-label=${T.close} @click=${close}>${icons.close}</button>
        </header>
        ${D.help.sections.map(
          ({ where, keys }) => html`<section class="keys">
            <h3>${where}</h3>
            <dl>${keys.map(([names, what]) => html`<div><dt>${names.map((name) => html`<kbd>${name}</kbd>`)}</dt><dd>${what}</dd></div>`)}</dl>
          </section>`,
        )}
      </div>
    </dialog>`;
  }
}

customElements.define('od-help', Help);
