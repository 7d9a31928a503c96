// The sheet of keys.

import { html } from 'lit';
import { effect } from '@preact/signals-core';
import * as state from '../state';
import { icons } from './icons';
import { View } from './view';

const KEYS: { where: string; keys: [string[], string][] }[] = [
  {
    where: 'Anywhere',
    keys: [
      [['Space'], 'Pause the console; frames go on being captured'],
      [['?'], 'This sheet'],
    ],
  },
  {
    where: 'Shaft',
    keys: [
      [['←', '→'], 'Turn by 5°; with Shift by 0.1°'],
      [['Page Up', 'Page Down'], 'Turn by one revolution'],
      [['Home'], 'Turn to the sensor’s zero point'],
    ],
  },
  {
    where: 'Frames',
    keys: [
      [['Enter'], 'Choose the newest frame and show it in full'],
      [['↑', '↓'], 'Go to the frame before or after'],
      [['Esc'], 'Close the chosen frame'],
    ],
  },
  {
    where: 'Send line',
    keys: [
      [['Enter'], 'Send the frame'],
      [['↑', '↓'], 'Frames sent before'],
    ],
  },
];

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
          <h2 id="help-title">Keys</h2>
          <button class="icon-button" aria-label="Close" @click=${close}>${icons.close}</button>
        </header>
        ${KEYS.map(
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
