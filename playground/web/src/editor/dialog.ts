// The editor of an EDS: the text, and beside it the findings, the sections, and the differences for
// a master.

import { html, nothing } from 'lit';
import { effect } from '@preact/signals-core';
import { download, openDevice, undoReplace } from '../actions';
import { sheet } from '../sheet';
import * as state from '../state';
import { T } from '../texts';
import { E } from './texts';
import { icons } from '../views/icons';
import { View } from '../views/view';
import type { Difference, Finding, Found, Origin } from './api';
import { ask, restarted, send, uriOf } from './client';
import { Code, type Action } from './code';
import { FindingList } from './list';
import './outline';

const SIDES = ['findings', 'outline', 'changes'] as const;
type Side = (typeof SIDES)[number];
/** Number of differences that are shown; the others are counted. */
const MOST_CHANGES = 300;

class Editor extends View {
  static override properties = { side: { state: true }, found: { state: true }, note: { state: true }, changes: { state: true }, ran: { state: true } };
  declare side: Side;
  declare found: Found | null;
  /** Result of the last action. */
  declare note: { text: string; isBad: boolean };
  declare changes: Difference[] | null;
  declare ran: boolean;
  private code: Code | undefined;
  private list: FindingList | undefined;
  /** The edited text, its initial content, and its origin. */
  private device: state.OpenedDevice | null = null;
  private original = '';
  private origin: Origin = { text: '' };
  /** The text that runs, and edited texts of other devices. */
  private running = '';
  private readonly drafts = new Map<string, { since: string[]; text: string }>();
  private key = '';
  private fixes: { finding: Finding; actions: Action[] } | null = null;
  private unopen: (() => void) | undefined;
  private compared = 0;

  constructor() {
    super();
    this.side = 'findings';
    this.clear();
    restarted.add(() => void this.again());
  }

  private clear(): void {
    this.found = null;
    this.note = { text: '', isBad: false };
    this.changes = null;
    this.ran = false;
    this.fixes = null;
  }

  protected override firstUpdated(): void {
    const dialog = this.querySelector('dialog')!;
    this.unopen = effect(() => {
      const { value } = state.editing;
      if (value && !dialog.open) void Promise.all([sheet('dialogs'), sheet('editing')]).then(() => this.open(dialog, value));
      else if (!value && dialog.open) dialog.close();
    });
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    this.unopen?.();
  }

  private async open(dialog: HTMLDialogElement, wanted: state.Editing): Promise<void> {
    dialog.showModal();
    const isSame = this.device && this.code && this.device.name === wanted.name && this.device.place === wanted.place && ([this.original, this.running, this.code.text].includes(wanted.text) || (wanted.builtin && wanted.builtin === ('name' in this.origin && this.origin.name)));
    this.device = wanted;
    if (!isSame) await this.load(wanted);
    if (wanted.at) this.code?.go(wanted.at);
    else this.code?.view.focus();
  }

  private async load(wanted: state.Editing): Promise<void> {
    const { name, text, bytes, builtin, place } = wanted;
    if (this.code) {
      if (this.code.isChanged) this.drafts.set(this.key, { since: [this.original, this.running], text: this.code.text });
      send({ op: 'close', uri: this.code.uri });
    }
    this.key = `${place}/${name}`;
    this.code?.dispose();
    this.list?.dispose();
    this.clear();
    this.origin = builtin ? { name: builtin } : bytes ? { bytes } : { text };
    const uri = uriOf(name);
    this.original = this.running = await ask('open', uri, this.origin);
    const on = { found: (found: Found) => this.check(found), changed: () => this.changed(), leave: () => this.close() };
    this.code = new Code(this.querySelector<HTMLElement>('.code')!, uri, this.original, on);
    this.list = new FindingList(this.querySelector<HTMLElement>('.found')!, uri, (finding) => void this.choose(finding), (finding) => this.offered(finding));
    const outline = this.querySelector('od-outline')!;
    outline.uri = uri;
    outline.go = (line) => this.code?.go({ line, character: 0 });
    outline.refresh();
    if (this.code.isMixed) this.note = { text: E.editor.mixed(this.code.ending), isBad: false };
    const draft = this.drafts.get(this.key);
    this.drafts.delete(this.key);
    // Only changes of the same text; those of another file with this name are ignored.
    if (draft?.since.includes(this.original)) {
      this.code.replace(draft.text);
      this.note = { text: E.editor.draft, isBad: false };
    }
  }

  /** The worker crashed: the current text is opened in a new one. */
  private async again(): Promise<void> {
    const { code } = this;
    if (!code) return;
    this.note = { text: E.broken, isBad: true };
    await ask('open', code.uri, { text: code.text });
    code.reopened();
  }

  private check(found: Found): void {
    this.found = found;
    this.fixes = null;
    this.list?.show(found);
    if (this.side === 'outline') this.querySelector('od-outline')?.refresh();
    if (this.side === 'changes') void this.compare();
  }

  private changed(): void {
    this.ran = false;
    if (this.note.text) this.note = { text: '', isBad: false };
  }

  private show(side: Side): void {
    this.side = side;
    if (side === 'outline') this.querySelector('od-outline')?.refresh();
    if (side === 'changes') void this.compare();
  }

  private async compare(): Promise<void> {
    const { code } = this;
    if (!code) return;
    const number = (this.compared += 1);
    const changes = await ask('compare', this.original, code.text);
    if (number === this.compared) this.changes = changes;
  }

  private async choose(finding: Finding): Promise<void> {
    this.code?.go(finding.range.start, false);
    const actions = (await this.code?.actions(finding.range, finding.code)) ?? [];
    this.fixes = { finding, actions };
    this.list?.redraw();
  }

  /** The fixes of the selected finding. */
  private offered(finding: Finding) {
    const { fixes } = this;
    if (fixes?.finding !== finding) return nothing;
    if (fixes.actions.length === 0) return html`<p class="muted">${E.editor.noFix}</p>`;
    return html`<div class="fixes">${fixes.actions.map(
      ({ title, edits }) => html`<button class="small" @click=${() => { this.code?.apply(edits); this.code?.view.focus(); }}>${title.replaceAll('`', '')}</button>`,
    )}</div>`;
  }

  private async fixAll(): Promise<void> {
    const done = await this.code?.fixAll();
    this.note = { text: done ? E.editor.fixed : E.editor.nothingToFix, isBad: false };
  }

  private async jump(): Promise<void> {
    if (!(await this.code?.jump())) this.note = { text: E.editor.noTarget, isBad: true };
  }

  /** Boots the device with the text; if that is not possible, the cursor moves to the first error. */
  private async run(lenient = false): Promise<void> {
    const { code, device } = this;
    if (!code || !device) return;
    const { name, nodeId, place } = device;
    const { text } = code;
    const { node, why } = await openDevice({ kind: 'eds', name, text, lenient }, nodeId, place, false);
    if (node === null) {
      const error = why ? undefined : await this.list?.pick(0);
      this.note = { text: error ? E.editor.cannot(error.range.start.line + 1, error.message) : why || E.editor.cannotNow, isBad: true };
      if (error) {
        this.side = 'findings';
        code.view.focus();
      }
      return;
    }
    this.device = { ...device, place: node };
    this.ran = true;
    this.running = text;
    this.key = `${node}/${name}`;
    this.note = { text: (lenient ? E.editor.ranLenient : E.editor.ran)(nodeId), isBad: false };
    this.show('changes');
  }

  private async save(): Promise<void> {
    const { code, device } = this;
    if (code && device) download(new Uint8Array(await ask('encode', this.origin, code.isChanged ? code.text : this.original)), device.name);
  }

  private close(): void {
    state.editing.value = null;
  }

  protected override render() {
    const e = E.editor;
    const { found, note, device } = this;
    const cannot = note.isBad && found && found.counts.error > 0;
    return html`<dialog class="dialog editor" aria-labelledby="editor-title" @close=${() => this.close()}>
      <header class="dialog-head">
        <h2 id="editor-title">${device ? e.title(device.name, device.nodeId) : ''}</h2>
        <div class="editor-buttons">
          <button class="primary" @click=${() => void this.run()} title=${e.runTitle}>${icons.play}${e.run}</button>
          <button @click=${() => void this.fixAll()} title=${e.fixAllTitle}>${e.fixAll}</button>
          <button @click=${() => void this.jump()} title=${e.jumpTitle}>${e.jump}</button>
          <button @click=${() => this.code?.search()} title=${e.searchTitle}>${e.search}</button>
          <button @click=${() => void this.save()}>${e.save}</button>
        </div>
        <button class="icon-button" aria-label=${T.close} @click=${() => this.close()}>${icons.close}</button>
      </header>
      <div class="editor-note" role="status" data-bad=${note.isBad} ?hidden=${!note.text}>${note.text}
        ${this.ran ? html`<button class="small" @click=${() => this.close()}>${e.toBench}</button>` : nothing}
        ${this.ran && state.replaced.value ? html`<button class="small" @click=${() => { this.ran = false; void undoReplace(); this.close(); }}>${T.dialog.undo(state.replaced.value.name)}</button>` : nothing}
        ${cannot ? html`<button class="small" title=${T.dialog.anywayTitle} @click=${() => void this.run(true)}>${T.dialog.anyway}</button>` : nothing}</div>
      <div class="editor-body">
        <div class="code"></div>
        <aside class="editor-side" aria-label=${e.side}>
          <div class="segmented" role="group" aria-label=${e.side}>${SIDES.map(
            (side) => html`<button class="small" aria-pressed=${side === this.side} @click=${() => this.show(side)}>${e.sides[side]}</button>`,
          )}</div>
          <div class="side-part" ?hidden=${this.side !== 'findings'}>
            <p class="muted" role="status">${found ? E.counts(found.counts.error, found.counts.warning, found.counts.info) : E.checking}</p>
            <div class="found scroll" tabindex="0" role="group" aria-label=${E.report.list}></div>
          </div>
          <od-outline class="side-part" ?hidden=${this.side !== 'outline'}></od-outline>
          <div class="side-part" ?hidden=${this.side !== 'changes'}>${this.differences()}</div>
        </aside>
      </div>
    </dialog>`;
  }

  private differences() {
    const { changes } = this;
    if (!changes) return html`<p class="muted">${E.checking}</p>`;
    const breaking = changes.filter((one) => one.breaking).length;
    return html`<p class="muted">${E.changes.sum(changes.length, breaking)}</p>
      <ul class="changes scroll" tabindex="0" aria-label=${E.changes.list}>${changes.slice(0, MOST_CHANGES).map(
        ({ place, name, change, breaking }) => html`<li data-breaking=${breaking}><span class="num">${place}</span><span>${name}: ${change}${breaking ? html` <span class="badge">${E.changes.breaking}</span>` : nothing}</span></li>`,
      )}${changes.length > MOST_CHANGES ? html`<li><span></span><span>${E.changes.more(changes.length - MOST_CHANGES)}</span></li>` : nothing}</ul>`;
  }
}

customElements.define('od-editor', Editor);
