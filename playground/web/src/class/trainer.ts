// The page of the trainer: a row for each student, live; it offers lessons and empties the class for the next group.

import { html, nothing, type TemplateResult } from 'lit';
import { effect } from '@preact/signals-core';
import { german, language } from '../language';
import { icons } from '../views/icons';
import { languageButton } from '../views/language';
import { View } from '../views/view';
import { FINAL } from '../lessons/kept';
import { CASE, TEST } from './places';
import { C } from './texts';

/** A lesson of the list. */
interface Listed {
  name: string;
  title: string;
  isOwn?: boolean;
  de?: { title: string };
}

/** A student. Times are in seconds. */
interface Row {
  id: number;
  name: string;
  presence: 'here' | 'hidden' | 'lost';
  silent: number;
  at: { name: string; step: number; of: number; wrong: number; hints: number; shown: number } | null;
  idle: number;
  stuck: 'time' | 'wrong' | null;
  finished: string[];
  offer: string | null;
}

/** Milliseconds between two looks at the class, and that it has for its answer. */
const PAUSE = 1000;
const PATIENCE = 4000;

/** Number of stuck students that are named above the table, where their rows are marked. */
const NAMED = 3;

const KEY = 'odkit.trainer';

/** The token, which leaves the address so that a projector does not show it. */
function takeToken(): string {
  const given = location.hash.slice(1);
  try {
    if (given) sessionStorage.setItem(KEY, given);
    history.replaceState(null, '', location.pathname + location.search);
    return given || (sessionStorage.getItem(KEY) ?? '');
  } catch {
    return given;
  }
}

const time = (seconds: number): string => (seconds < 60 ? C.trainer.seconds(seconds) : C.trainer.minutes(Math.floor(seconds / 60)));

class Trainer extends View {
  static override properties = { rows: { state: true }, address: { state: true }, lessons: { state: true }, chosen: { state: true }, fault: { state: true }, isSure: { state: true } };
  declare rows: Row[];
  /** Address for the students; empty until the class has answered. */
  declare address: string;
  declare lessons: Listed[];
  /** Name of the lesson that is offered next. */
  declare chosen: string;
  /** Reason why there is no table; or that it is old. */
  declare fault: '' | 'outside' | 'token' | 'lost';
  /** The trainer is asked whether the class is to be emptied. */
  declare isSure: boolean;
  private token = takeToken();
  private heard = new Date();

  constructor() {
    super();
    this.rows = [];
    this.address = '';
    this.lessons = [];
    this.chosen = '';
    this.fault = '';
    this.isSure = false;
    // An address with the token of another class was opened.
    window.addEventListener('hashchange', () => location.hash && location.reload());
    effect(() => {
      void german.value;
      document.title = C.trainer.page;
    });
    if ('class' in document.documentElement.dataset) void this.look();
    else this.fault = 'outside';
  }

  private ask(what: string, body?: unknown): Promise<Response> {
    const headers = { 'x-odkit-trainer': this.token, 'content-type': 'application/json' };
    const signal = AbortSignal.timeout(PATIENCE);
    return fetch(`class/${what}`, body === undefined ? { headers, signal } : { method: 'POST', headers, signal, body: JSON.stringify(body) });
  }

  private async look(): Promise<void> {
    await this.read();
    // A program that was started again has another token, so asking again would not help.
    if (this.fault !== 'token') setTimeout(() => void this.look(), PAUSE);
  }

  private choose(name: string): void {
    this.chosen = name;
    // A page that is loaded again has the same choice.
    const place = new URL(location.href);
    place.searchParams.set('lesson', name);
    history.replaceState(null, '', place);
  }

  private async read(): Promise<void> {
    try {
      if (this.lessons.length === 0) {
        this.lessons = (await (await fetch('lessons.json')).json()) as Listed[];
        const before = new URLSearchParams(location.search).get('lesson');
        const first = this.lessons.find((one) => one.name === before) ?? this.lessons.find((one) => one.isOwn) ?? this.lessons[0];
        this.chosen ||= first?.name ?? '';
      }
      const response = await this.ask('rows');
      if (response.status === 403) {
        this.fault = 'token';
        return;
      }
      const { address, rows } = (await response.json()) as { address: string; rows: Row[] };
      [this.address, this.rows, this.fault, this.heard] = [address, rows, '', new Date()];
    } catch {
      this.fault = 'lost';
    }
  }

  private async act(what: string, body: unknown): Promise<void> {
    await this.ask(what, body).catch(() => (this.fault = 'lost'));
    await this.read();
  }

  private titleOf(name: string): string {
    if (name === CASE) return C.trainer.faultCase;
    if (name === TEST || name === FINAL) return C.trainer.finalTest;
    const one = this.lessons.find((other) => other.name === name);
    return (german.value && one?.de?.title) || one?.title || name;
  }

  private option(one: Listed): TemplateResult {
    return html`<option value=${one.name} ?selected=${one.name === this.chosen}>${this.titleOf(one.name)}</option>`;
  }

  private tools(): TemplateResult {
    const t = C.trainer;
    const own = this.lessons.filter((one) => one.isOwn);
    const others = this.lessons.filter((one) => !one.isOwn);
    return html`<div class="trainer-tools">
      <label><span>${t.lesson}</span><select @change=${(event: Event) => this.choose((event.target as HTMLSelectElement).value)}>
        ${own.length ? html`<optgroup label=${t.own}>${own.map((one) => this.option(one))}</optgroup>` : nothing}
        <optgroup label=${t.others}>${others.map((one) => this.option(one))}</optgroup></select></label>
      <button class="primary" ?disabled=${this.rows.length === 0} @click=${() => void this.act('offer', { lesson: this.chosen })}>${t.all}</button>
      <span class="spacer"></span>
      ${this.isSure
        ? html`<span class="sure" role="alert">${t.sure}</span>
            <button class="danger" @click=${() => { this.isSure = false; void this.act('reset', {}); }}>${t.yes}</button>
            <button @click=${() => (this.isSure = false)}>${t.no}</button>`
        : html`<button ?disabled=${this.rows.length === 0} @click=${() => (this.isSure = true)}>${t.reset}</button>`}
    </div>`;
  }

  private row(row: Row): TemplateResult {
    const t = C.trainer;
    const { at } = row;
    const isDone = at !== null && at.step >= at.of;
    const chosen = this.titleOf(this.chosen);
    return html`<tr data-presence=${row.presence} ?data-stuck=${row.stuck !== null}>
      <th scope="row"><strong>${row.name}</strong><span class="presence">${t.presence[row.presence]}${row.presence === 'lost' ? ` ${t.since(time(row.silent))}` : ''}</span></th>
      <td data-label=${t.columns.lesson}>${at ? this.titleOf(at.name) : html`<span class="muted">${t.free}</span>`}${row.offer ? html`<span class="offered">${t.offered(this.titleOf(row.offer))}</span>` : nothing}</td>
      <td data-label=${t.columns.step}>${at ? html`<span class="num">${isDone ? t.finished : t.step(at.step + 1, at.of)}</span><span class="steps" aria-hidden="true">${Array.from({ length: at.of }, (_, i) => html`<i data-state=${i < at.step ? 'done' : i === at.step ? 'now' : ''}></i>`)}</span>` : nothing}</td>
      <td data-label=${t.columns.time}>${at && !isDone && row.presence !== 'lost' ? html`<span class="num">${time(row.idle)}</span>` : nothing}${row.stuck ? html`<span class="reason">${t.reason[row.stuck]}</span>` : nothing}</td>
      <td data-label=${t.columns.answers} class="num">${at?.wrong || nothing}</td>
      <td data-label=${t.columns.help}>${at ? t.help(at.hints, at.shown) : nothing}</td>
      <td data-label=${t.columns.done} class="num" title=${row.finished.map((name) => this.titleOf(name)).join('\n')}>${row.finished.length || nothing}</td>
      <td class="acts"><button class="small" title=${t.oneTo(row.name, chosen)} aria-label=${t.oneTo(row.name, chosen)} @click=${() => void this.act('offer', { lesson: this.chosen, row: row.id })}>${t.one}</button>
        <button class="icon-button" title=${t.remove(row.name)} aria-label=${t.remove(row.name)} @click=${() => void this.act('remove', { row: row.id })}>${icons.close}</button></td>
    </tr>`;
  }

  private table(): TemplateResult {
    const t = C.trainer;
    const { columns } = t;
    if (this.rows.length === 0) return html`<p class="empty">${t.none}</p>`;
    return html`<table aria-label=${t.table}><thead><tr>${[columns.student, columns.lesson, columns.step, columns.time, columns.answers, columns.help, columns.done].map((one) => html`<th scope="col">${one}</th>`)}<th scope="col"><span class="sr">${columns.actions}</span></th></tr></thead>
      <tbody>${this.rows.map((row) => this.row(row))}</tbody></table>`;
  }

  private summary(): TemplateResult {
    const t = C.trainer;
    const here = this.rows.filter(({ presence }) => presence !== 'lost').length;
    const stuck = this.rows.filter((row) => row.stuck);
    const names = stuck.slice(0, NAMED).map((row) => `${row.name} (${this.titleOf(row.at!.name)}, ${row.at!.step + 1})`).join(', ');
    return html`<p class="summary" role="status">${this.rows.length ? t.sum(here, this.rows.length) : nothing}${stuck.length ? html` <strong>${t.stuck(names, Math.max(0, stuck.length - NAMED))}</strong>` : nothing}</p>`;
  }

  private content(): TemplateResult {
    const t = C.trainer;
    if (this.fault === 'outside') return html`<p class="empty" role="alert">${t.outside}</p>`;
    if (this.fault === 'token') return html`<p class="empty" role="alert">${t.noToken}</p>`;
    return html`${this.fault === 'lost' ? html`<p class="trainer-fault" role="alert">${t.lost(this.heard.toLocaleTimeString(language()))}</p>` : nothing}
      ${this.address ? html`<p class="invite">${t.invite} <strong class="num">${this.address}</strong></p>${this.tools()}${this.summary()}${this.table()}` : nothing}`;
  }

  protected override render() {
    return html`<header class="trainer-bar"><h1>${C.trainer.title}</h1><span class="spacer"></span>${languageButton()}</header>
      <main>${this.content()}</main>`;
  }
}

customElements.define('od-trainer', Trainer);
