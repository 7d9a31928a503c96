// A lab of the free bench, in the column that a lesson has.

import { html, nothing } from 'lit';
import { effect } from '@preact/signals-core';
import { remember } from '../actions';
import { sheet } from '../sheet';
import * as state from '../state';
import { besideSwitch } from '../views/beside';
import { icons } from '../views/icons';
import { View } from '../views/view';
import { shown } from './shown';
import { L } from './texts';

await sheet('lesson');

const close = (): void => {
  state.lab.value = null;
  if (state.tab.value === 'lesson' && !state.lesson.value) state.tab.value = 'encoder';
};

/** Closes the lab; a reload of the page does not open it again. */
const leave = (): void => {
  close();
  if (!state.lesson.value) remember();
};

class LabPanel extends View {
  private unfollow: (() => void) | undefined;

  override connectedCallback(): void {
    super.connectedCallback();
    // A lesson that is opened has labs of its own; a real bus has none.
    const before = state.lesson.peek();
    this.unfollow = effect(() => {
      if (state.lesson.value !== before || state.real.value) close();
    });
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.unfollow?.();
  }

  protected override render() {
    const name = state.lab.value;
    if (!name) return nothing;
    const { title } = L[name];
    return html`<header class="panel-head">
        <h2>${title}</h2>
        ${besideSwitch()}
        <button class="icon-button" aria-label=${L.close(title)} title=${L.close(title)} @click=${leave}>${icons.close}</button>
      </header>
      <div class="free-lab scroll" tabindex="0" role="region" aria-label=${title}>${shown(name)}</div>`;
  }
}

customElements.define('od-lab', LabPanel);
