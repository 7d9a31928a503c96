// The master on the bench: its list, and the boot process of each slave as a chart.

import { html, nothing } from 'lit';
import { live } from 'lit/directives/live.js';
import * as state from '../state';
import type { MasterSlave, MasterState } from '../sim/api';
import { said } from '../language';
import { askBus } from '../sim/link';
import { Lab } from './lab';
import { L } from './texts';

/** Stages of the boot process that compare a value of the list: for each the index in `checks`. */
const CHECKS: Record<number, number> = { 3: 0, 4: 1, 5: 2, 6: 3 };
const BOOT_UP = 2;

class Master extends Lab {
  static override properties = { known: { state: true }, draft: { state: true }, wrong: { state: true } };
  declare known: MasterState | null;
  /** The text while the user changes it; null: it is that of the master. */
  declare draft: string | null;
  declare wrong: string;

  constructor() {
    super();
    this.known = null;
    this.draft = null;
    this.wrong = '';
  }

  protected override async look(): Promise<void> {
    const known = await askBus('master');
    if (JSON.stringify(known) !== JSON.stringify(this.known)) this.known = known;
  }

  private get text(): string {
    return this.draft ?? this.known?.lines.join('\n') ?? '';
  }

  private async boot(): Promise<void> {
    const lines = this.text.split('\n');
    const orders = lines.map((line) => (/^\s*(#|$)/.test(line) ? '' : `master ${line.trim().replace(/^master\s+/, '')}`));
    const failed = await this.play(['master clear', ...orders, 'master boot']);
    const line = failed ? failed.line - 1 : 0;
    // A message quotes lines of a script; a line of the list is without the first word.
    const why = said(failed?.why.replaceAll('`master ', '`') ?? '');
    this.wrong = failed && line > 0 && line <= lines.length ? L.master.line(line, why) : why;
    if (!failed) this.draft = null;
  }

  private async clear(): Promise<void> {
    await this.play(['master clear']);
    this.draft = null;
    this.wrong = '';
  }

  private chart(slave: MasterSlave) {
    const t = L.master;
    const start = slave.began[0] ?? 0;
    const isOpen = slave.state === 'waiting';
    const state = (i: number): string => {
      if (isOpen || i > slave.stage) return 'open';
      if (i === slave.stage && slave.state === 'failed') return 'failed';
      if (i === slave.stage && slave.state === 'booting') return 'now';
      if (i === BOOT_UP && slave.silent) return 'missed';
      const check = CHECKS[i];
      return check !== undefined && i !== 3 && !slave.checks[check] ? 'skipped' : 'done';
    };
    return html`<section class="slave">
      <h4>${t.node(slave.node)} <span class="pill" data-tone=${slave.state === 'started' ? 'good' : slave.state === 'failed' || slave.state === 'lost' ? 'bad' : ''}>${t.slave[slave.state]}</span></h4>
      <ol class="stages" aria-label=${t.chart(slave.node)}>${t.stages.map((name, i) => {
        const is = state(i);
        const at = slave.began[i];
        return html`<li data-state=${is} title=${`${t.objects[i]}: ${t.stage[is]}`}><span>${name}</span><small class="num">${at !== undefined && is !== 'open' ? t.after((at - start) / 1000) : t.objects[i]}</small><span class="sr">, ${t.stage[is]}</span></li>`;
      })}</ol>
      ${slave.status ? html`<p class="note" data-tone="error">${t.status(slave.status, said(slave.meaning))}${slave.reason ? html` <span class="num">(${said(slave.reason)})</span>` : nothing}</p>` : slave.reason ? html`<p class="note" data-tone="error">${said(slave.reason)}</p>` : nothing}
      ${slave.dcf ? html`<details><summary>${t.dcf(slave.node)}</summary><code class="num">${slave.dcf}</code></details>` : nothing}
    </section>`;
  }

  protected override render() {
    const t = L.master;
    const isChanged = this.draft !== null && this.draft.trim() !== (this.known?.lines.join('\n') ?? '');
    return html`<section class="lab" aria-label=${t.title}>
      <header><h3>${t.title}</h3><span class="spacer"></span>
        <button class="small primary" title=${t.bootTitle} @click=${() => void this.boot()}>${t.boot}</button>
        <button class="small" title=${t.clearTitle} @click=${() => void this.clear()}>${t.clear}</button></header>
      <textarea class="num" rows="5" spellcheck="false" autocapitalize="off" aria-label=${t.list} placeholder=${t.hint(state.nodeId.value)} .value=${live(this.text)}
        @input=${(event: Event) => { this.draft = (event.target as HTMLTextAreaElement).value; this.wrong = ''; }}></textarea>
      <p class="note" role="status" data-tone=${this.wrong ? 'error' : ''} ?hidden=${!this.wrong && !isChanged}>${this.wrong || t.changed}</p>
      <div class="charts" aria-live="polite">${this.known?.slaves.length ? this.known.slaves.map((slave) => this.chart(slave)) : html`<p class="note">${t.none}</p>`}</div>
      <details ?open=${!this.known?.slaves.length}><summary>${t.guide}</summary><dl class="orders">${t.orders.map(([line, what]) => html`<dt class="num">${line}</dt><dd>${what}</dd>`)}</dl></details>
    </section>`;
  }
}

customElements.define('od-master', Master);
