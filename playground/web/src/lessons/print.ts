// A lesson on paper: a handout for students, or the same with all solutions for the trainer.

import { html, nothing, render } from 'lit';
import { use } from '../sim/link';
import type { Lesson } from '../sim/api';
import * as state from '../state';
import { markdown } from '../views/markdown';
import { spaced } from '../views/quiz';
import { D } from '../views/texts';
import { textOf } from './open';
import type { Listed } from './own';

const sheetOf = (lesson: Lesson, hasSolutions: boolean) => {
  const t = D.lessons.print;
  return html`<h1>${lesson.title}</h1>
    <p class="about">${D.lessons.levels[lesson.level]} · ${D.lessons.minutes(lesson.minutes)}${hasSolutions ? ` · ${t.solutions}` : ''}</p>
    ${hasSolutions ? nothing : html`<p class="fields"><span>${t.name}</span><span>${t.date}</span></p>`}
    <div class="prose">${markdown(lesson.intro)}</div>
    ${lesson.steps.map((step, i) => html`<section><h2>${i + 1}. ${step.title}</h2>
      <div class="prose">${markdown(step.text)}</div>
      ${step.quiz ? html`<div class="ask"><h3>${D.lessons.predict}</h3><div class="prose">${markdown(step.quiz.question)}</div>
        ${hasSolutions ? html`<p><code>${spaced(step.quiz.answer)}</code></p><div class="prose">${markdown(step.quiz.reveal)}</div>` : html`<p class="line"></p>`}</div>` : nothing}
      ${hasSolutions
        ? html`<h3>${t.solution}</h3><pre>${step.solution.trim()}</pre><h3>${D.lessons.happened}</h3><div class="prose">${markdown(step.happened)}</div>`
        : html`<h3>${t.notes}</h3><p class="line"></p><p class="line"></p>`}</section>`)}`;
};

/** Prints a lesson of the list. */
export async function print(one: Listed, hasSolutions: boolean): Promise<void> {
  const text = await textOf(one).catch(() => null);
  const read = text === null ? null : await use('parseLesson', text);
  const lesson = read && 'value' in read ? read.value.lesson : null;
  if (!lesson) {
    state.toast.value = { text: D.lessons.unreachable(one.title, D.lessons.print.failed), tone: 'error' };
    return;
  }
  document.querySelector('body > .handout')?.remove();
  const home = document.createElement('article');
  home.className = 'handout';
  home.lang = lesson.language;
  render(sheetOf(lesson, hasSolutions), home);
  document.body.append(home);
  window.addEventListener('afterprint', () => home.remove(), { once: true });
  window.print();
}
