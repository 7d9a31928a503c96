// The column beside the bus during a lesson or in a lab: that, or the objects.

import { html, nothing } from 'lit';
import * as state from '../state';
import { T } from '../texts';

/** What the column has beside the objects, in a word. */
export const besideWord = (): string => T.app.tabs[state.lab.value ? 'lab' : 'lesson'];

export const besideSwitch = () =>
  state.isBeside.value
    ? html`<div class="side-switch segmented" role="group" aria-label=${T.lessons.beside}>
        <button class="small" aria-pressed=${state.tab.value !== 'objects'} @click=${() => (state.tab.value = 'lesson')}>${besideWord()}</button>
        <button class="small" aria-pressed=${state.tab.value === 'objects'} @click=${() => (state.tab.value = 'objects')}>${T.app.tabs.objects}</button>
      </div>`
    : nothing;
