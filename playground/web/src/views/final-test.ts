// The final test: questions of all lessons without their recipe, and a certificate to print.

import { html, nothing, type TemplateResult } from 'lit';
import { codeOf, FINAL, finished, NEEDED, progress, QUESTIONS, reached } from '../lessons/kept';
import { openNamed, questions, type Asked } from '../lessons/open';
import { keep, kept } from '../lessons/tab';
import { language } from '../language';
import { use } from '../sim/link';
import { markdown } from './markdown';
import { spaced } from './quiz';
import { D } from './texts';
import { View } from './view';

/** All in random order. */
function shuffled<Item>(all: Item[]): Item[] {
  const rest = [...all];
  return all.map(() => rest.splice(Math.floor(Math.random() * rest.length), 1)[0]!);
}

/** Questions of different lessons. */
function drawn(all: Asked[]): Asked[] {
  const lessons = new Map(shuffled(all).map((one) => [one.lesson, one]));
  return shuffled([...lessons.values()]).slice(0, QUESTIONS);
}

class FinalTest extends View {
  static override properties = { asked: { state: true }, given: { state: true }, note: { state: true }, learner: { state: true } };
  /** Null: they could not be loaded. */
  declare asked: Asked[] | null;
  declare given: { text: string; isRight: boolean }[];
  declare note: string;
  /** A name for the certificate; it is not stored. */
  declare learner: string;
  /** Language of the questions. */
  private shown = '';

  constructor() {
    super();
    this.note = '';
    this.learner = '';
    this.asked = [];
    this.given = [];
  }

  /** Continues the test of before a reload, or of another language; otherwise begins one. */
  private resume(): void {
    this.shown = language();
    questions().then((all) => {
      const before = kept('test');
      const asked = before?.asked.map(([lesson, step]) => all.find((one) => one.lesson === lesson && one.step === step));
      if (!before || !asked?.every((one) => one !== undefined)) return this.begin();
      [this.asked, this.given] = [asked, before.given];
    }, () => (this.asked = null));
  }

  private begin(): void {
    this.given = [];
    questions().then((all) => {
      this.asked = drawn(all);
      this.keep();
    }, () => (this.asked = null));
  }

  private keep(): void {
    keep('test', { asked: (this.asked ?? []).map(({ lesson, step }) => [lesson, step]), given: this.given });
  }

  private answered(text: string, isRight: boolean): void {
    this.given = [...this.given, { text, isRight }];
    this.note = '';
    this.keep();
    const all = this.asked?.length ?? 0;
    if (this.given.length === all) reached(FINAL, this.right, all, false);
    else void this.updateComplete.then(() => this.querySelector('input')?.focus());
  }

  private get right(): number {
    return this.given.filter((one) => one.isRight).length;
  }

  private async check(event: Event, one: Asked): Promise<void> {
    event.preventDefault();
    const field = this.querySelector('input')!;
    const text = field.value.trim();
    if (!text) {
      this.note = D.lessons.test.empty;
      return;
    }
    const judged = await use('judgeAnswer', one.answer, text);
    if (!('value' in judged)) {
      this.note = D.lessons.noFrame;
      return;
    }
    field.value = '';
    this.answered(text, judged.value.right);
  }

  private ask(one: Asked, all: number): TemplateResult {
    const t = D.lessons.test;
    return html`<form class="test-question" @submit=${(event: Event) => void this.check(event, one)}>
      <h3>${t.question(this.given.length + 1, all)}</h3>
      <div class="prose question">${markdown(one.question)}</div>
      <div class="button-row"><input class="mono" aria-label=${D.lessons.answer} placeholder=${D.lessons.answerHint} autocomplete="off" spellcheck="false">
        <button class="primary" type="submit">${t.next}</button>
        <button type="button" @click=${() => this.answered('', false)}>${t.skip}</button></div>
      <p role="status">${this.note}</p>
    </form>`;
  }

  /** Answers that were not right, each with its lesson. */
  private wrong(asked: Asked[]): TemplateResult {
    const t = D.lessons.test;
    return html`<section class="wrong-answers"><h3>${t.wrong}</h3><ol>${asked.map((one, i) => this.given[i]!.isRight
      ? nothing
      : html`<li class="prose"><div>${markdown(one.question)}</div><div>${t.yours(this.given[i]!.text)}</div>
          <div>${t.right} <code>${spaced(one.answer)}</code></div><div>${markdown(one.reveal)}</div>
          <button class="small" @click=${() => void openNamed(one.lesson)}>${one.title}</button></li>`)}</ol></section>`;
  }

  private certificate(all: number): TemplateResult {
    const t = D.lessons.test;
    const name = this.learner.trim();
    const done = [...finished()].filter((one) => one !== FINAL).length;
    return html`<div class="share-field"><label for="certificate-name">${D.lessons.code.learner}</label>
        <input id="certificate-name" autocomplete="name" maxlength="60" .value=${this.learner} @input=${(event: Event) => (this.learner = (event.target as HTMLInputElement).value)}>
        <button class="primary" ?disabled=${!name} @click=${() => window.print()}>${t.print}</button></div>
      ${name ? html`<section class="certificate" aria-label=${t.certificate}>
        <h3>${t.certificate}</h3><p>${t.of}</p><strong>${name}</strong><p>${t.result(this.right, all)}</p>
        <p>${t.lessons(done)} · ${new Date().toLocaleDateString(language(), { dateStyle: 'long' })}</p>
        <small>${t.code}<code>${codeOf(name, progress())}</code></small></section>` : nothing}`;
  }

  protected override render() {
    const t = D.lessons.test;
    if (this.shown !== language()) this.resume();
    const { asked } = this;
    if (!asked) return html`<p class="note" role="alert">${D.lessons.noList}</p>`;
    const one = asked[this.given.length];
    if (one) return this.ask(one, asked.length);
    if (asked.length === 0) return html`<p class="note" role="status">${D.lessons.loading}</p>`;
    const isPassed = this.right >= NEEDED;
    return html`<p class="lesson-end" role="status">${t.sum(this.right, asked.length)} ${isPassed ? t.passed : t.failed(NEEDED)}</p>
      ${isPassed ? this.certificate(asked.length) : nothing}
      <div class="button-row"><button class=${isPassed ? '' : 'primary'} @click=${() => this.begin()}>${t.again}</button></div>
      ${this.right < asked.length ? this.wrong(asked) : nothing}`;
  }
}

customElements.define('od-final-test', FinalTest);
