// Opens a lab in the column beside the bus.

import { html } from 'lit';
import { remember } from '../actions';
import { add } from '../sim/link';
import * as state from '../state';
import { load, type Name } from './shown';
import { L } from './texts';

const NAMES: readonly Name[] = ['master', 'line'];

/** Opens a lab of the free bench; an unknown name opens none. It needs a line with bit times, and the whole module. */
export async function openLab(wanted: string): Promise<void> {
  const name = NAMES.find((one) => one === wanted);
  if (!name) return;
  await Promise.all([load(name), import('./panel'), add({ op: 'script', text: 'line real' })]);
  state.lab.value = name;
  state.tab.value = 'lesson';
  // A lesson keeps its own address.
  if (!state.lesson.value) remember();
}

/** The labs as cards of the list of lessons. */
export const cards = (done: () => void) => html`<h3 id="labs" class="lesson-level">${L.labs}</h3>
  <ol class="lesson-list" aria-labelledby="labs">${NAMES.map((name) => html`<li><button class="card" @click=${() => { done(); void openLab(name); }}><strong>${L[name].title}</strong><span>${L[name].summary}</span></button></li>`)}</ol>`;
