// The fault cases: a list, and a case with its probes, its causes and the mark. The whole module plays them; the page only shows.

import { html, nothing, type TemplateResult } from 'lit';
import { copyText } from '../clipboard';
import { load } from '../lessons/open';
import { keep as keepInTab, kept, type KeptCase } from '../lessons/tab';
import { german } from '../language';
import type { CaseMark, FaultCase, OpenedCase, ProbeReading } from '../sim/api';
import { use } from '../sim/link';
import { sheet } from '../sheet';
import * as state from '../state';
import { icons } from '../views/icons';
import { markdown } from '../views/markdown';
import { D } from '../views/texts';
import { View } from '../views/view';
import { F } from './texts';

await sheet('cases');

/** Cases that were solved with a proof, in this browser. */
const KEY = 'odkit.cases';
/** Seeds are short, so that a trainer can say one. */
const SEEDS = 10_000;

function solved(): string[] {
  try {
    const known: unknown = JSON.parse(localStorage.getItem(KEY) ?? '[]');
    return Array.isArray(known) ? known.filter((name) => typeof name === 'string') : [];
  } catch {
    return [];
  }
}

function keep(name: string): void {
  try {
    localStorage.setItem(KEY, JSON.stringify([...new Set([...solved(), name])]));
  } catch {
    // Storage is not allowed: nothing is kept.
  }
}

const newSeed = (): number => Math.floor(Math.random() * SEEDS);

/** The text of the cases and its translation, in the language of the page. */
async function texts(): Promise<[text: string, german: string]> {
  return Promise.all([load('cases.en.md'), german.value ? load('cases.de.md') : '']);
}

class FaultCases extends View {
  static override properties = { list: { state: true }, opened: { state: true }, readings: { state: true }, chosen: { state: true }, mark: { state: true }, note: { state: true }, isBusy: { state: true }, isCopied: { state: true } };
  /** Null: they could not be loaded. */
  declare list: FaultCase[] | null;
  declare opened: OpenedCase | null;
  /** The probes in the order in which they were made. */
  declare readings: Map<number, ProbeReading>;
  declare chosen: number | null;
  declare mark: CaseMark | null;
  declare note: string;
  declare isBusy: boolean;
  declare isCopied: boolean;
  /** The case on show, with its seed and language. */
  private shown = '';

  constructor() {
    super();
    this.list = [];
    this.clear();
  }

  private clear(): void {
    this.opened = null;
    this.readings = new Map();
    this.chosen = null;
    this.mark = null;
    this.note = '';
    this.isBusy = false;
    this.isCopied = false;
  }

  /** Loads what the address or the list asks for. */
  private async follow(): Promise<void> {
    const wanted = state.faultCase.value;
    const shown = `${wanted?.name ?? ''} ${wanted?.seed ?? ''} ${german.value !== null}`;
    if (wanted === null || shown === this.shown) return;
    this.shown = shown;
    this.clear();
    try {
      const both = await texts();
      const list = await use('faultCases', ...both);
      if ('error' in list) throw new Error(list.error);
      this.list = list.value;
      if (!wanted.name) return;
      const opened = await use('openCase', ...both, wanted.name, wanted.seed);
      if ('error' in opened) throw new Error(opened.error);
      if (shown !== this.shown) return;
      this.opened = opened.value;
      const before = kept('case');
      if (before?.name === wanted.name && before.seed === wanted.seed) await this.restore(before);
      history.replaceState(null, '', `${location.pathname}${location.search}#case=${wanted.name}&seed=${wanted.seed}`);
    } catch {
      this.list = null;
    }
  }

  /** Makes the probes of before a reload again, or of another language; each reads as it did. */
  private async restore(before: KeptCase): Promise<void> {
    const { shown } = this;
    this.chosen = before.chosen;
    for (const number of before.probes) if (shown === this.shown) await this.probe(number);
    if (shown !== this.shown) return;
    if (before.isMarked) await this.judge();
  }

  private keep(): void {
    const wanted = state.faultCase.value;
    if (wanted) keepInTab('case', { ...wanted, probes: [...this.readings.keys()], chosen: this.chosen, isMarked: this.mark !== null });
  }

  private open(name: string, seed = newSeed()): void {
    state.faultCase.value = { name, seed };
  }

  private async probe(number: number): Promise<void> {
    const wanted = state.faultCase.value;
    if (!wanted || this.isBusy || this.readings.has(number)) return;
    this.isBusy = true;
    const shown = this.shown;
    const told = await use('tryProbe', ...(await texts()), wanted.name, wanted.seed, number);
    if (shown !== this.shown) return;
    this.isBusy = false;
    if ('value' in told) {
      this.readings = new Map([...this.readings, [number, told.value]]);
      this.keep();
    } else this.note = told.error;
  }

  private async judge(): Promise<void> {
    const wanted = state.faultCase.value;
    if (!wanted || this.isBusy) return;
    if (this.chosen === null) {
      this.note = F.nothing;
      return;
    }
    this.isBusy = true;
    const shown = this.shown;
    const [text, words] = await texts();
    // One cause after the other: the bench goes on between them.
    const rows: string[] = [];
    for (let cause = 0; cause < this.opened!.causes.length; cause += 1) {
      const row = await use('caseRow', text, wanted.name, wanted.seed, cause);
      if (shown !== this.shown) return;
      if ('value' in row) rows.push(...row.value);
    }
    const mark = await use('judgeCase', text, words, wanted.name, wanted.seed, rows, Uint32Array.from(this.readings.keys()), this.chosen);
    if (shown !== this.shown) return;
    this.isBusy = false;
    this.note = '';
    if ('error' in mark) {
      this.note = mark.error;
      return;
    }
    this.mark = mark.value;
    this.keep();
    if (mark.value.isRight && mark.value.isProven) keep(wanted.name);
    await this.updateComplete;
    this.querySelector('.case-mark')?.scrollIntoView({ block: 'nearest' });
  }

  private trace(reading: ProbeReading) {
    if (reading.frames.length === 0) return nothing;
    return html`<details><summary>${F.frames(reading.frames.length + reading.more)}</summary><ol class="case-frames num" tabindex="0">
      ${reading.frames.map((one) => html`<li ?data-error=${one.isError}><span>${(one.at / 1000).toFixed(1)} ms</span><span>${one.id}</span><span>${one.data}</span><span>${one.isError ? F.errorFrame : one.words}</span></li>`)}
      ${reading.more ? html`<li>${F.more(reading.more)}</li>` : nothing}</ol></details>`;
  }

  private told(number: number) {
    const used = this.mark?.used ?? [];
    const at = used.findIndex((one) => one.probe === number);
    if (at < 0) return nothing;
    const before = at === 0 ? this.opened!.causes.length : used[at - 1]!.left.length;
    return html`<p class="case-told">${F.told(before - used[at]!.left.length, used[at]!.left.length)}</p>`;
  }

  private result(opened: OpenedCase, mark: CaseMark) {
    const left = mark.used.at(-1)?.left.length ?? opened.causes.length;
    return html`<section class="case-mark" role="status" data-tone=${mark.isRight ? (mark.isProven ? 'good' : 'amber') : 'bad'}>
      <p><strong>${mark.isRight ? F.right : F.wrong(opened.causes[mark.cause]!)}</strong>
        ${mark.isProven ? F.proven(mark.used.length, mark.fewest) : F.guessed(left, mark.fewest)}</p>
      <h4>${F.explanation}</h4><div class="prose">${markdown(mark.proof)}</div>
      <h4>${F.best}</h4><ul>${mark.best.map((probe) => html`<li>${opened.probes[probe]}</li>`)}</ul>
      <div class="button-row"><button class="primary" @click=${() => this.open(state.faultCase.peek()!.name)}>${F.another}</button>
        <button @click=${() => this.open('')}>${F.all}</button></div>
    </section>`;
  }

  private case(opened: OpenedCase, { name, seed }: { name: string; seed: number }): TemplateResult {
    const isOver = this.mark !== null;
    const copy = (): void => void copyText(location.href).then((isCopied) => (this.isCopied = isCopied));
    return html`<div class="case-head"><h3>${opened.title}</h3><span class="spacer"></span><span class="num muted">${F.seed(seed)}</span>
        <button class="small" title=${F.copyTitle} @click=${copy}>${this.isCopied ? F.copied : F.copy}</button>
        <button class="small" title=${F.anotherTitle} @click=${() => this.open(name)}>${F.another}</button>
        <button class="small" @click=${() => this.open('')}>${F.all}</button></div>
      <div class="prose">${markdown(opened.story)}</div>
      <div class="case-parts">
        <section aria-labelledby="case-probes"><h4 id="case-probes">${F.probes} <span class="muted">${F.used(this.readings.size)}</span></h4>
          <p class="note">${F.each}</p>
          <ol class="case-probes">${opened.probes.map((text, number) => {
            const reading = this.readings.get(number);
            return html`<li data-made=${reading !== undefined}>${reading
              ? html`<strong>${text}</strong><ul aria-live="polite">${reading.lines.map((line) => html`<li>${line}</li>`)}</ul>${this.told(number)}${this.trace(reading)}`
              : html`<button class="card" ?disabled=${this.isBusy || isOver} @click=${() => void this.probe(number)}>${text}</button>`}</li>`;
          })}</ol></section>
        <section aria-labelledby="case-causes"><h4 id="case-causes">${F.cause}</h4>
          <fieldset class="choices" ?disabled=${isOver} aria-labelledby="case-causes">${opened.causes.map((text, number) => html`<label class="choice" data-is=${isOver && number === this.mark!.cause ? 'right' : isOver && number === this.chosen ? 'wrong' : ''}>
            <input type="radio" name="case-cause" .checked=${this.chosen === number} @change=${() => { this.chosen = number; this.note = ''; this.keep(); }}><span>${text}</span></label>`)}</fieldset>
          ${isOver ? nothing : html`<div class="button-row"><button class="primary" ?disabled=${this.isBusy} @click=${() => void this.judge()}>${F.name}</button><span role="status" class="note">${this.note}</span></div>`}
          ${this.mark ? this.result(opened, this.mark) : nothing}</section>
      </div>`;
  }

  protected override render() {
    void this.follow();
    if (this.list === null) return html`<p class="note" role="alert">${F.failed}</p>`;
    const { value: wanted } = state.faultCase;
    // The dialog is closed: a lesson or another address was opened.
    if (wanted === null) return html`${nothing}`;
    if (this.opened) return this.case(this.opened, wanted);
    if (wanted.name || this.list.length === 0) return html`<p class="note" role="status">${D.lessons.loading}</p>`;
    const done = solved();
    return html`<p class="note">${F.hint}</p>
      <ol class="lesson-list">${this.list.map((one) => html`<li><button class="card" @click=${() => this.open(one.name)}><strong>${one.title}${done.includes(one.name)
        ? html` <span class="done-mark" title=${F.solved}>${icons.tick}<span class="sr">${F.solved}</span></span>`
        : nothing}</strong></button></li>`)}</ol>`;
  }
}

customElements.define('od-fault-cases', FaultCases);
