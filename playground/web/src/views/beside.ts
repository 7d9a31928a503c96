// The column beside the bus during a lesson: the lesson, or the objects.

import { html, nothing } from 'lit';
import * as state from '../state';
import { T } from '../texts';

export const besideSwitch = () =>
  state.lesson.value
    ? html`<div class="side-switch segmented" role="group" aria-label=${T.lessons.beside}>
        <button class="small" aria-pressed=${state.tab.value !== 'objects'} @click=${() => (state.tab.value = 'lesson')}>${T.app.tabs.lesson}</button>
        <button class="small" aria-pressed=${state.tab.value === 'objects'} @click=${() => (state.tab.value = 'objects')}>${T.app.tabs.objects}</button>
      </div>`
    : nothing;
