// The quiz of a step: predict a frame, then see it.

import { html, nothing } from 'lit';
import type { Judgement, Lesson } from '../sim/api';
import { use } from '../sim/link';
import * as state from '../state';
import { markdown } from './markdown';
import { D } from './texts';
import { View } from './view';

type Asked = NonNullable<Lesson['steps'][number]['quiz']>;

/** Bytes to check again, counted from 0. */
function wrongParts(found: Judgement): string {
  const t = D.lessons;
  const bytes = found.wrongBytes.join(', ');
  return [found.wrongIdentifier ? t.wrongId : '', found.wrongLength ? t.wrongLength : '', bytes ? t.wrongBytes(bytes) : ''].filter(Boolean).join(t.and);
}

/** A frame with spaces between its bytes. */
export const spaced = (frame: string): string => frame.replace(/#(.*)/, (_, bytes: string) => `#${bytes.match(/..?/g)?.join(' ') ?? ''}`);

class Quiz extends View {
  static override properties = { quiz: { attribute: false }, short: { attribute: false }, said: { state: true }, isTold: { state: true } };
  declare quiz: Asked;
  /** The question without its recipe, which can be opened; empty if there is none. */
  declare short: string;
  declare said: string;
  declare isTold: boolean;

  constructor() {
    super();
    this.short = '';
    this.said = '';
    this.isTold = false;
  }

  private async check(event: Event): Promise<void> {
    event.preventDefault();
    const given = this.querySelector('input')!.value.trim();
    if (!given) return;
    const judged = await use('judgeAnswer', this.quiz.answer, given);
    const found = 'value' in judged ? judged.value : null;
    this.isTold ||= found?.right ?? false;
    if (found && !found.right) state.effort.value = { ...state.effort.peek(), wrong: state.effort.peek().wrong + 1 };
    this.said = !found ? D.lessons.noFrame : found.right ? D.lessons.right : D.lessons.wrong(wrongParts(found));
  }

  protected override render() {
    const t = D.lessons;
    return html`<form class="quiz" @submit=${(event: Event) => void this.check(event)}>
      <h4>${t.predict}</h4>
      <div class="prose question">${markdown(this.short || this.quiz.question)}</div>
      ${this.short ? html`<details><summary>${t.recipe}</summary><div class="prose">${markdown(this.quiz.question)}</div></details>` : nothing}
      ${this.isTold
        ? nothing
        : html`<div class="button-row"><input class="mono" aria-label=${t.answer} placeholder=${t.answerHint} autocomplete="off" spellcheck="false">
          <button class="small" type="submit">${t.check}</button>
          <button class="small" type="button" @click=${() => (this.isTold = true)}>${t.reveal}</button></div>`}
      <p role="status">${this.said}</p>
      ${this.isTold ? html`<p><code>${spaced(this.quiz.answer)}</code></p><div class="prose">${markdown(this.quiz.reveal)}</div>` : nothing}
    </form>`;
  }
}

customElements.define('od-quiz', Quiz);
