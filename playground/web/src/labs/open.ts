// Opens a lab in the column beside the bus.

import { html } from 'lit';
import { add } from '../sim/link';
import * as state from '../state';
import { load, type Name } from './shown';
import { L } from './texts';

/** Opens a lab of the free bench. It needs a line with bit times, and the whole module. */
async function openLab(name: Name): Promise<void> {
  await Promise.all([load(name), import('./panel'), add({ op: 'script', text: 'line real' })]);
  state.lab.value = name;
  state.tab.value = 'lesson';
}

/** The labs as cards of the list of lessons. */
export const cards = (done: () => void) => html`<h3 id="labs" class="lesson-level">${L.labs}</h3>
  <ol class="lesson-list" aria-labelledby="labs">${(['master', 'line'] as const).map((name) => html`<li><button class="card" @click=${() => { done(); void openLab(name); }}><strong>${L[name].title}</strong><span>${L[name].summary}</span></button></li>`)}</ol>`;
