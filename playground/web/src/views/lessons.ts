// The list of lessons, and lessons of the user.

import { html, nothing, type PropertyValues, type TemplateResult } from 'lit';
import { effect } from '@preact/signals-core';
import { TEST } from '../class/places';
import { C } from '../class/texts';
import { copyText } from '../clipboard';
import { cards } from '../labs/open';
import { language } from '../language';
import { F } from '../cases/texts';
import { codeOf, finished, NEEDED, progress, QUESTIONS, type Done, type Progress } from '../lessons/kept';
import { lessons, openFile, openNamed, words } from '../lessons/open';
import { begunTest } from '../lessons/tab';
import { changes, clear, openAll, type Listed } from '../lessons/own';
import { sheet } from '../sheet';
import * as state from '../state';
import { T } from '../texts';
import { icons } from './icons';
import { languageButton } from './language';
import { D } from './texts';
import { load, View } from './view';

await sheet('dialogs');

/** Gives the page the address of its lesson, or of no lesson, in place of that of a fault case or of the final test. */
function leave(): void {
  const name = state.lesson.value ? state.lessonRun.value.name : '';
  history.replaceState(null, '', `${location.pathname}${location.search}${name ? `#lesson=${encodeURIComponent(name)}` : ''}`);
}

class Lessons extends View {
  static override properties = { list: { state: true }, learner: { state: true }, isCopied: { state: true }, isTest: { state: true } };
  /** Null: it could not be loaded. */
  declare list: Listed[] | null;
  /** A name for the code; it is not stored. */
  declare learner: string;
  declare isCopied: boolean;
  /** The final test is in the place of the list. */
  declare isTest: boolean;
  private unopen: (() => void) | undefined;

  constructor() {
    super();
    this.list = [];
    this.learner = '';
    this.isCopied = false;
    this.isTest = false;
  }

  protected override firstUpdated(changed: PropertyValues): void {
    super.firstUpdated(changed);
    const dialog = this.querySelector('dialog')!;
    this.unopen = effect(() => {
      void changes.value;
      if (state.lessonDialog.value) {
        if (!dialog.open) dialog.showModal();
        if (state.finalTest.peek()) this.beginTest();
        this.load();
        this.requestUpdate();
      } else if (!state.lessonDialog.value && dialog.open) {
        dialog.close();
      }
    });
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.unopen?.();
  }

  private beginTest(): void {
    state.finalTest.value = false;
    load(async () => {
      await import('./final-test');
      this.isTest = true;
      history.replaceState(null, '', `${location.pathname}${location.search}${TEST}`);
    });
  }

  private failed() {
    return state.lessonFailed.value.map(({ name, problems }) => html`<section class="faults" role="alert">
      <header role="none"><h3>${D.lessons.failed(name, problems.length)}</h3></header>
      <ol class="scroll" tabindex="0" aria-label=${D.lessons.failed(name, problems.length)}>${problems.map((one) => html`<li data-severity="error">
        <span class="where">${one.line ? D.lessons.line(one.line) : nothing}</span>
        <span>${one.message}${one.help ? html`<span class="help muted">${one.help}</span>` : nothing}</span></li>`)}</ol>
    </section>`);
  }

  /** The name in a class; otherwise the progress as a code, for a trainer. */
  private code() {
    const known = progress();
    const { value: member } = state.member;
    if (member) return html`<section class="share-field"><p class="note">${member.name ? C.student.member(member.name) : C.student.none}</p><button @click=${() => { state.lessonDialog.value = false; member.change(); }}>${C.student.change}</button></section>`;
    if (Object.keys(known).length === 0) return nothing;
    const t = D.lessons.code;
    const code = codeOf(this.learner, known);
    return html`<section class="share-field progress-code" aria-label=${t.title}>
      <label for="learner">${t.title}</label>
      <p class="note">${t.hint}</p>
      <input id="learner" placeholder=${t.learner} aria-label=${t.learner} autocomplete="name" maxlength="60" .value=${this.learner} @input=${(event: Event) => { this.learner = (event.target as HTMLInputElement).value; this.isCopied = false; }}>
      <button ?disabled=${this.learner.trim() === ''} @click=${() => void copyText(code).then((isCopied) => (isCopied ? (this.isCopied = true) : this.querySelector<HTMLInputElement>('#progress-code')?.select()))}>${this.isCopied ? D.share.copied : t.copy}</button>
      ${this.learner.trim() ? html`<input id="progress-code" class="num" readonly aria-label=${t.code} .value=${code} @focus=${(event: Event) => (event.target as HTMLInputElement).select()}>` : nothing}
    </section>`;
  }

  private card(one: Listed, isDone: boolean, kept: Done | undefined) {
    const t = D.lessons;
    const [steps = 0, all = 0, , shown = 0] = kept ?? [];
    const state = isDone
      ? html` <span class="done-mark" title=${t.done}>${icons.tick}<span class="sr">${t.done}</span></span>`
      : steps > 0 ? html` <span class="muted num">${t.count(steps, all)}</span>` : nothing;
    const { title, summary } = words(one);
    const isForeign = language() === 'de' && !one.de;
    return html`<li><button class="card" @click=${() => void openNamed(one.name)}>
      <strong>${title}${state}</strong>
      ${summary ? html`<span>${summary}</span>` : nothing}
      <span class="muted">${t.minutes(one.minutes)}${isForeign ? `, ${t.onlyEnglish}` : ''}${shown ? `, ${t.shown(shown)}` : ''}</span></button></li>`;
  }

  /** Lessons under a heading; nothing without lessons. */
  private group(id: string, title: string, group: Listed[], done: Set<string>, known: Progress) {
    if (group.length === 0) return nothing;
    const t = D.lessons;
    return html`<h3 id=${id} class="lesson-level">${title} <span class="muted num">${t.count(group.filter((one) => done.has(one.name)).length, group.length)}</span>
        ${group.some((one) => one.text !== undefined) ? html`<button class="small" @click=${() => void clear()}>${t.own.remove}</button>` : nothing}</h3>
      <ol class="lesson-list" aria-labelledby=${id}>${group.map((one) => this.card(one, done.has(one.name), known[one.name]))}</ol>`;
  }

  /** A lesson on paper. */
  private paper() {
    if (!this.list?.length) return nothing;
    const t = D.lessons.print;
    const print = (hasSolutions: boolean): void => {
      const name = this.querySelector<HTMLSelectElement>('#paper')?.value;
      const one = this.list?.find((other) => other.name === name);
      if (one) void import('../lessons/print').then(({ print: begin }) => begin(one, hasSolutions));
    };
    return html`<section class="paper"><label for="paper">${t.title}</label>
      <select id="paper">${this.list.map((one) => html`<option value=${one.name}>${words(one).title}</option>`)}</select>
      <button @click=${() => print(false)}>${t.handout}</button><button @click=${() => print(true)}>${t.solutions}</button></section>`;
  }

  private load(): void {
    lessons().then((list) => (this.list = list), () => (this.list = null));
  }

  /** The dialog with this title and content. */
  private framed(close: () => void, title: string, content: TemplateResult): TemplateResult {
    return html`<dialog class="dialog wide" aria-labelledby="lessons-title" @close=${close} @click=${(event: Event) => event.target === event.currentTarget && close()}>
      <div class="dialog-body">
        <header class="dialog-head"><h2 id="lessons-title">${title}</h2><div class="spacer"></div>${languageButton()}<button class="icon-button" aria-label=${T.close} @click=${close}>${icons.close}</button></header>
        <od-offers></od-offers>
        ${content}
      </div>
    </dialog>`;
  }

  protected override render() {
    const t = D.lessons;
    const done = finished();
    const known = progress();
    const begun = begunTest();
    const close = (): void => {
      state.lessonDialog.value = false;
      state.lessonFailed.value = [];
      if (this.isTest || state.faultCase.value?.name) leave();
      this.isTest = false;
      state.faultCase.value = null;
    };
    if (state.faultCase.value) {
      const isThere = customElements.get('od-fault-cases') !== undefined;
      if (!isThere) load(() => import('../cases/view').then(() => this.requestUpdate()));
      return this.framed(close, F.title, html`${isThere ? html`<od-fault-cases></od-fault-cases>` : html`<p class="note" role="status">${D.lessons.loading}</p>`}<div><button @click=${() => (state.faultCase.value = null)}>${F.back}</button></div>`);
    }
    if (this.isTest) return this.framed(close, D.lessons.test.title, html`<od-final-test></od-final-test><div><button @click=${() => { leave(); this.isTest = false; }}>${D.lessons.test.back}</button></div>`);
    return this.framed(close, T.lessons.title, html`${this.failed()}
        ${this.list === null ? html`<p class="note" role="alert">${t.noList}</p>` : this.list.length === 0 ? html`<p class="note" role="status">${t.loading}</p>` : nothing}
        ${this.group('own-lessons', t.own.title, (this.list ?? []).filter((one) => one.isOwn), done, known)}
        ${t.levels.map((level, number) => this.group(`level-${number}`, level, (this.list ?? []).filter((one) => one.level === number && !one.isOwn), done, known))}
        ${state.real.value || state.devices.value.length === 0 ? nothing : cards(close)}
        <section class="share-field"><p class="note">${t.test.hint(QUESTIONS, NEEDED)}</p><button @click=${() => this.beginTest()}>${!begun ? t.test.begin : begun.given < begun.all ? t.test.goOn(begun.given + 1, begun.all) : t.test.last}</button></section>
        <section class="share-field"><p class="note">${F.hint}</p><button @click=${() => (state.faultCase.value = { name: '', seed: 0 })}>${F.begin}</button></section>
        ${this.paper()}
        ${this.code()}
        <label class="drop">${icons.file}<span><strong>${t.open}</strong><span class="muted">${t.openHint}</span></span>
          <input class="sr" type="file" multiple accept=".md,.markdown,text/markdown,text/plain" aria-label=${t.open} @change=${(event: Event) => {
            const input = event.target as HTMLInputElement;
            const files = [...(input.files ?? [])];
            if (files.length > 1) void openAll(files);
            else if (files[0]) void openFile(files[0]);
            // The same file can be selected again after a correction.
            input.value = '';
          }}></label>
        <p class="note">${t.write.hint}
          <a download href="sample-lesson.md">${t.write.sample}</a>, <a download href="LESSONS.md">${t.write.lessons}</a>, <a download href="SCRIPTS.md">${t.write.scripts}</a></p>
`);
  }
}

customElements.define('od-lessons', Lessons);
