// The column beside the bus: during a lesson or a lab it shows the lesson, the lab or the objects.

import { html, nothing } from 'lit';
import * as state from '../state';
import { T } from '../texts';

/** Name of what the column can show instead of the objects. */
export const besideWord = (): string => T.app.tabs[state.lab.value ? 'lab' : 'lesson'];

export const besideSwitch = () =>
  state.isBeside.value
    ? html`<div class="side-switch segmented" role="group" aria-label=${T.lessons.beside}>
        <button class="small" aria-pressed=${state.tab.value !== 'objects'} @click=${() => (state.tab.value = 'lesson')}>${besideWord()}</button>
        <button class="small" aria-pressed=${state.tab.value === 'objects'} @click=${() => (state.tab.value = 'objects')}>${T.app.tabs.objects}</button>
      </div>`
    : nothing;
