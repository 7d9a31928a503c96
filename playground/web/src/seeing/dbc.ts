// A DBC file beside the EDS names: its signals follow the words of each frame.

import { html, nothing } from 'lit';
import { signal } from '@preact/signals-core';
import { use } from '../sim/link';
import { addSignals } from '../sim/words';
import * as state from '../state';
import { icons } from '../views/icons';
import { View } from '../views/view';
import './style';
import { S } from './texts';

/** The open file; null: none. */
const file = signal<{ name: string; messages: number } | null>(null);

/** Opens a DBC file; it replaces the one before. */
export async function opened(name: string, bytes: Uint8Array): Promise<boolean> {
  const read = await use('readDbc', bytes);
  if ('error' in read) {
    state.toast.value = { text: S.dbc.wrong(name, read.error), tone: 'error' };
    return false;
  }
  const [messages = 0, leftOut = 0] = read.value;
  file.value = { name, messages };
  addSignals(async (frames) => {
    const words = await use('dbcWords', bytes, frames);
    return 'value' in words ? words.value : [];
  });
  state.toast.value = { text: S.dbc.opened(name, messages, leftOut), tone: 'info' };
  return true;
}

/** Its name, and a button that closes it. */
class Dbc extends View {
  private close(): void {
    file.value = null;
    addSignals(null);
  }

  protected override render() {
    const { value } = file;
    if (!value) return nothing;
    return html`<span class="pill" title=${S.dbc.title(value.messages)}>${value.name} <button class="icon-button dbc-close" aria-label=${S.dbc.close(value.name)} title=${S.dbc.close(value.name)} @click=${() => this.close()}>${icons.close}</button></span>`;
  }
}

customElements.define('od-dbc', Dbc);
