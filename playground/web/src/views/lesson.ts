// The lesson beside the bench: the task, completed and open conditions, hints one by
// one, and the explanation.

import { html, nothing, type TemplateResult } from 'lit';
import { keyed } from 'lit/directives/keyed.js';
import { effect } from '@preact/signals-core';
import { leaveLesson, playScript, setRunning } from '../actions';
import { beside, labsOf } from '../labs/shown';
import { language } from '../language';
import { reached } from '../lessons/kept';
import { again, backTo, following, lessons, openNamed, recalled, shortOf, translated, words, type Asked } from '../lessons/open';
import type { Listed } from '../lessons/own';
import { sheet } from '../sheet';
import type { Lesson, LessonState } from '../sim/api';
import * as state from '../state';
import { besideSwitch } from './beside';
import { icons } from './icons';
import { markdown } from './markdown';
import './quiz';
import { D } from './texts';
import { View } from './view';

await sheet('lesson');

/** Minimum height of a window in which a lesson shows its introduction in full, or has room for a lab and a question. */
const TALL = 900;
/** Below this height a question of a lesson without a lab is beside its step, not above the checklist. */
const LOW = 700;
/** A lesson has a column of its own from this width on; otherwise the page scrolls. */
const WIDE = 1024;
/** Below this height the checklist of a narrow window scrolls. */
const FLAT = 560;

type Step = Lesson['steps'][number];

/** Returns whether a low window or a lab leaves little room: the instructions come first, and a question is beside its step. */
const isTight = (lesson: Lesson): boolean => window.innerWidth >= WIDE && window.innerHeight < (labsOf(lesson).length > 0 ? TALL : LOW);

const choose = (): void => void (state.lessonDialog.value = true);

class LessonPanel extends View {
  static override properties = { seen: { state: true }, hints: { state: true }, upNext: { state: true }, listed: { state: true }, recall: { state: true }, short: { state: true } };
  /** The step that is shown: a completed step stays until the learner continues. */
  declare seen: number;
  declare hints: number;
  /** The lesson after this one, when this one is done; null if all are done. */
  declare upNext: Listed | null | undefined;
  /** This lesson in the list; null if it is not a built-in one. */
  declare listed: Listed | null;
  /** A question of an earlier lesson. */
  declare recall: Asked | null;
  /** Questions without their recipe, by step. */
  declare short: Map<number, string>;
  /** Whether the solution was played for this step. */
  private isShown = false;
  private unfollow: (() => void) | undefined;
  private unwatch: (() => void) | undefined;
  /** The place of a question depends on the window. */
  private readonly resized = (): void => this.requestUpdate();

  constructor() {
    super();
    this.seen = 0;
    this.hints = 0;
    this.upNext = undefined;
    this.listed = null;
    this.recall = null;
    this.short = new Map();
  }

  override connectedCallback(): void {
    super.connectedCallback();
    window.addEventListener('resize', this.resized);
    this.unfollow = effect(() => {
      const { name, step } = state.lessonRun.value;
      this.seen = step;
      void lessons().then((list) => (this.listed = list.find((one) => one.name === name) ?? null), () => (this.listed = null));
      void shortOf(name).then((short) => (this.short = short), () => (this.short = new Map()));
      void recalled(name).then((one) => (this.recall = one), () => (this.recall = null));
      this.hints = 0;
      this.isShown = false;
      this.upNext = undefined;
    });
    // A step that is done while another panel covers the lesson.
    let before = Infinity;
    let told: typeof state.toast.value = null;
    this.unwatch = effect(() => {
      const { step = Infinity } = state.lessonState.value ?? {};
      if (state.tab.value === 'lesson' && told && state.toast.peek() === told) state.toast.value = null;
      if (step === before + 1 && !state.lessonOpening.peek() && !this.checkVisibility()) {
        told = { text: D.lessons.stepDone(step), tone: 'info', action: { text: D.lessons.happened, run: () => (state.tab.value = 'lesson') } };
        state.toast.value = told;
      }
      before = step;
    });
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    window.removeEventListener('resize', this.resized);
    this.unfollow?.();
    this.unwatch?.();
  }

  private hint(): void {
    this.hints += 1;
    state.effort.value = { ...state.effort.peek(), hints: this.hints };
    void this.updateComplete.then(() => this.querySelector('.hint:last-of-type')?.scrollIntoView({ block: 'nearest' }));
  }

  private next(step: number): void {
    // Another panel, such as that of the other language, begins with this step.
    state.lessonRun.value = { ...state.lessonRun.peek(), step };
    setRunning(true);
    void this.updateComplete.then(() => {
      const text = this.querySelector<HTMLElement>('.lesson');
      text?.scrollTo(0, 0);
      text?.focus();
      this.scrollIntoView({ block: 'nearest' });
    });
  }

  /** A completed step: the explanation first, then the task. */
  private done(step: Step, isLast: boolean): TemplateResult {
    const t = D.lessons;
    return html`<div class="happened" role="status"><h4>${icons.tick} ${t.happened}</h4><div class="prose">${markdown(step.happened)}</div></div>
      ${isLast ? html`<p class="lesson-end" role="status">${t.finished}${this.upNext === null ? ` ${t.allDone}` : ''}</p>` : nothing}
      <details><summary>${t.asked}</summary><div class="prose">${markdown(step.text)}</div></details>`;
  }

  private goOn(number: number, isLast: boolean): TemplateResult {
    const t = D.lessons;
    return isLast
      ? html`<div class="button-row">${this.upNext ? html`<button class="primary" @click=${() => void openNamed(this.upNext!.name)}>${t.following(words(this.upNext).title)}</button>` : nothing}<button @click=${choose}>${t.other}</button><button @click=${() => void again()}>${t.again}</button></div>`
      : html`<div class="button-row"><button class="primary" @click=${() => this.next(number + 1)}>${t.next}</button>
          ${state.running.value ? nothing : html`<span class="still">${icons.pause} ${t.still}</span>`}</div>`;
  }

  /** Restores the bench as the step found it; shown hints stay. */
  private async back(number: number): Promise<void> {
    const { hints } = this;
    await backTo(number);
    this.hints = hints;
  }

  /** Offer of the lesson in another language. */
  private foreign(lesson: Lesson, shown: number) {
    if (lesson.language === language()) return nothing;
    const t = D.lessons;
    const one = this.listed;
    const isThere = one && (language() === 'en' || one.de) && !state.real.value;
    return html`<p class="begin">${t.foreign}${isThere ? html` <button class="small" @click=${() => void translated(one, shown)}>${t.translate}</button>` : nothing}</p>`;
  }

  /** Plays the solution, on a repeated bench if this one cannot reach it. */
  private async show(step: Step, number: number, isLost: boolean): Promise<void> {
    if (isLost || this.isShown) await this.back(number);
    this.isShown = true;
    await playScript(step.solution);
  }

  private quiz(step: Step, number: number) {
    const isOurs = state.lesson.value?.language === language();
    return step.quiz ? html`<od-quiz .quiz=${step.quiz} .short=${isOurs ? (this.short.get(number) ?? '') : ''}></od-quiz>` : nothing;
  }

  private open(step: Step, number: number, progress: LessonState, isBeside: boolean): TemplateResult {
    const t = D.lessons;
    const isLost = progress.step === number && progress.requirements.some(({ lost }) => lost);
    return html`${isBeside ? nothing : this.quiz(step, number)}
      <div class="asked"><ul class="checks" tabindex=${window.innerHeight < FLAT && window.innerWidth < WIDE ? 0 : nothing} aria-live="polite" aria-label=${t.checks}>${progress.requirements.map(
        (one) => html`<li data-done=${one.holds} ?data-already=${one.already}>${one.holds ? icons.tick : html`<i></i>`}<span>${one.already ? nothing : html`<span class="sr">${one.holds ? t.isDone : t.isOpen}</span>`}${one.text}${one.already ? html` <em>(${t.already})</em>` : nothing}</span></li>`,
      )}</ul>
      ${this.hints < step.hints.length
        ? html`<button class="small" @click=${this.hint}>${this.hints ? t.nextHint : t.hint}</button>`
        : step.solution && !state.real.value ? html`<button class="small" title=${t.showTitle} @click=${() => void this.show(step, number, isLost)}>${t.show}</button>` : nothing}
      ${isLost || state.real.value ? nothing : html`<button class="icon-button" aria-label=${t.back} title=${t.back} @click=${() => void this.back(number)}>${icons.reset}</button>`}
      ${progress.idle ? html`<p class="lost" role="status">${t.idle}</p>` : nothing}
      ${isLost && !state.real.value ? html`<div class="lost" role="status"><span>${t.lost}</span><button class="small" @click=${() => void this.back(number)}>${t.back}</button></div>` : nothing}</div>`;
  }

  protected override render() {
    const lesson = state.lesson.value;
    const progress = state.lessonState.value;
    if (!lesson || !progress) return nothing;
    const t = D.lessons;
    const all = lesson.steps.length;
    // A step back in time may lead to an earlier step.
    const shown = Math.min(this.seen, progress.step, all - 1);
    const step = lesson.steps[shown]!;
    const isDone = progress.step > shown;
    const isLast = shown === all - 1;
    // The reason comes first; the rest can be opened if the window is low.
    const [why, ...more] = lesson.intro.trim().split(/\n\s*\n/);
    const isFirst = shown === 0 && why !== undefined && why !== '' && !isDone;
    const isBeside = isTight(lesson);
    const recall = this.recall ? html`<details class="recall"><summary>${t.recall(this.recall.title)}</summary><od-quiz .quiz=${this.recall}></od-quiz></details>` : nothing;
    const { name } = state.lessonRun.value;
    // A resumed lesson has no name until its run is restored.
    if (name && !state.lessonOpening.value) reached(name, progress.step, all, this.isShown);
    if (isDone && isLast && this.upNext === undefined) void following(name).then((next) => (this.upNext = next));
    return html`
      <header class="panel-head">
        <h2>${lesson.title}</h2>
        <div class="spacer"></div>
        ${besideSwitch()}
        <button class="icon-button" aria-label=${t.other} title=${t.other} aria-haspopup="dialog" @click=${choose}>${icons.lesson}</button>
        <button class="icon-button" aria-label=${t.leave} title=${t.leave} @click=${leaveLesson}>${icons.close}</button>
      </header>
      <div class="lesson scroll" tabindex="0" role="region" aria-label=${lesson.title} lang=${lesson.language}>
        <div class="lesson-steps" role="img" aria-label=${t.step(shown + 1, all)}>${lesson.steps.map((_, i) => html`<i data-state=${i < progress.step ? 'done' : i === shown ? 'now' : ''}></i>`)}</div>
        ${this.foreign(lesson, shown)}
        ${!isFirst
          ? nothing
          : isBeside
            ? html`<details><summary>${t.background}</summary><div class="prose">${markdown(lesson.intro)}</div></details>`
            : html`<div class="prose">${markdown(why)}</div>
              ${more.length ? html`<details ?open=${window.innerHeight >= TALL}><summary>${t.background}</summary><div class="prose">${markdown(more.join('\n\n'))}</div></details>` : nothing}
              ${recall}
              <p class="begin">${icons.down} ${t.begin}</p>`}
        ${keyed(
          `${state.lessonRun.value.count}/${shown}`,
          html`<section class="lesson-step">
            <h3><span class="muted num">${shown + 1}</span> ${step.title}</h3>
            ${isDone ? this.done(step, isLast) : html`<div class="prose">${markdown(step.text)}</div>`}
            ${isDone ? nothing : step.hints.slice(0, this.hints).map((hint) => html`<div class="hint prose">${markdown(hint)}</div>`)}
            ${isDone || !isBeside ? nothing : this.quiz(step, shown)}
            ${isFirst && isBeside ? recall : nothing}
          </section>`,
        )}
      </div>
      ${beside(lesson)}
      <footer class="lesson-foot">${keyed(`${state.lessonRun.value.count}/${shown}`, isDone ? this.goOn(shown, isLast) : this.open(step, shown, progress, isBeside))}</footer>`;
  }
}

customElements.define('od-lesson', LessonPanel);
