// Opens a lab in the column beside the bus, or the labs that a lesson needs within it.

import { html, nothing } from 'lit';
import { add } from '../sim/link';
import type { Lesson } from '../sim/api';
import * as state from '../state';
import { L } from './texts';

type Name = NonNullable<typeof state.lab.value>;

const parts = { master: () => import('./master'), line: () => import('./line') };

export const shown = (name: Name) => (name === 'master' ? html`<od-master></od-master>` : html`<od-line-lab></od-line-lab>`);

const load = (name: Name): Promise<unknown> =>
  parts[name]().catch(() => (state.toast.value = { text: L.failed, tone: 'error' }));

/** The labs that the solutions of a lesson use. */
export function labsOf(lesson: Lesson): Name[] {
  const uses = (word: RegExp): boolean => lesson.steps.some(({ solution }) => word.test(solution));
  const names: Name[] = [];
  if (uses(/^\s*master /m)) names.push('master');
  if (uses(/^\s*line (length|sample-point|sjw|clock) /m)) names.push('line');
  return names;
}

/** The labs of a lesson, as a part of its panel. */
export function beside(lesson: Lesson) {
  if (state.real.value) return nothing;
  return labsOf(lesson).map((name) => {
    void load(name);
    return html`<div class="lesson-lab">${shown(name)}</div>`;
  });
}

/** Opens a lab of the free bench. It needs a line with bit times, and the whole module. */
async function openLab(name: Name): Promise<void> {
  await Promise.all([load(name), import('./panel'), add({ op: 'script', text: 'line real' })]);
  state.lab.value = name;
  state.tab.value = 'lesson';
}

/** The labs as cards of the list of lessons. */
export const cards = (done: () => void) => html`<h3 id="labs" class="lesson-level">${L.labs}</h3>
  <ol class="lesson-list" aria-labelledby="labs">${(['master', 'line'] as const).map((name) => html`<li><button class="card" @click=${() => { done(); void openLab(name); }}><strong>${L[name].title}</strong><span>${L[name].summary}</span></button></li>`)}</ol>`;
