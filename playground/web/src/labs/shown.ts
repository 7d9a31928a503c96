// The labs as elements, which are loaded when they are needed, and the labs of a lesson.

import { html, nothing } from 'lit';
import type { Lesson } from '../sim/api';
import * as state from '../state';
import { L } from './texts';

export type Name = NonNullable<typeof state.lab.value>;

const parts = { master: () => import('./master'), line: () => import('./line') };

/** The element of a lab. */
export const shown = (name: Name) => (name === 'master' ? html`<od-master></od-master>` : html`<od-line-lab></od-line-lab>`);

/** Loads a lab; what keeps it from that is said. */
export const load = (name: Name): Promise<unknown> =>
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
