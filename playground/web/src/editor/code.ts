// The text of an EDS in CodeMirror, connected to the language server. It has a shadow root: there
// its style sheets are objects, which the page's policy allows, and not elements.

import { autocompletion, closeCompletion, selectedCompletion, type CompletionContext, type CompletionResult } from '@codemirror/autocomplete';
import { defaultKeymap, history, historyKeymap, insertNewlineAndIndent } from '@codemirror/commands';
import { openSearchPanel, search, searchKeymap } from '@codemirror/search';
import { ChangeSet, EditorSelection, EditorState, Prec, type Text, type TransactionSpec } from '@codemirror/state';
import { drawSelection, EditorView, highlightActiveLine, highlightActiveLineGutter, hoverTooltip, keymap, lineNumbers, type Tooltip, type ViewUpdate } from '@codemirror/view';
import { render } from 'lit';
import { markdown } from '../views/markdown';
import type { Found } from './api';
import { ask, listen, send } from './client';
import { E } from './texts';
import { colours, dotted, marks, setMarks } from './marks';
import type { CodeAction, CompletionItem, Hover, Location, Position, Range, TextEdit } from './protocol';
import { theme } from './theme';

/** A fix, or another edit that a finding offers. */
export interface Action {
  title: string;
  edits: TextEdit[];
}

export class Code {
  readonly view: EditorView;
  /** The end of a line in the file. */
  private readonly lineEnd: string;
  /** The file has both kinds of line ends: it is saved with one. */
  readonly isMixed: boolean;
  private readonly first: Text;
  private version = 1;
  /** Versions that are being checked, and the changes since each. */
  private unchecked: { version: number; doc: Text; since: ChangeSet | null }[];
  private readonly unlisten: () => void;

  constructor(
    place: HTMLElement,
    readonly uri: string,
    text: string,
    private readonly on: { found(found: Found): void; changed(): void; leave(): void },
  ) {
    const crlf = text.split('\r\n').length - 1;
    const all = text.split('\n').length - 1;
    this.lineEnd = crlf > 0 && crlf * 2 >= all ? '\r\n' : '\n';
    this.isMixed = crlf > 0 && crlf < all;
    const root = place.shadowRoot ?? place.attachShadow({ mode: 'open' });
    root.replaceChildren();
    const state = EditorState.create({
      doc: text,
      extensions: [
        EditorView.contentAttributes.of({ 'aria-label': E.editor.text, tabindex: '0', spellcheck: 'false', autocapitalize: 'off', autocorrect: 'off' }),
        lineNumbers(),
        dotted,
        marks,
        colours,
        history(),
        drawSelection(),
        highlightActiveLine(),
        highlightActiveLineGutter(),
        search({ top: true }),
        // Before autocompletion, whose keys have the same precedence.
        Prec.highest(keymap.of([{ key: 'Enter', run: (view) => this.isWhole(view) && closeCompletion(view) && insertNewlineAndIndent(view) }])),
        autocompletion({ override: [(context) => this.complete(context)], icons: false }),
        hoverTooltip((_, at) => this.hover(at), { hoverTime: 250 }),
        keymap.of([
          { key: 'F12', run: () => (void this.jump(), true) },
          { key: 'F8', run: () => this.next(1), shift: () => this.next(-1) },
          ...searchKeymap,
          ...historyKeymap,
          ...defaultKeymap,
          { key: 'Escape', run: () => (this.on.leave(), true) },
        ]),
        EditorView.domEventHandlers({
          click: (event) => {
            if (!event.ctrlKey && !event.metaKey) return false;
            void this.jump();
            return true;
          },
        }),
        EditorView.updateListener.of((update) => this.updated(update)),
        theme,
      ],
    });
    this.first = state.doc;
    this.view = new EditorView({ state, root, parent: root });
    this.unchecked = [{ version: 1, doc: state.doc, since: null }];
    this.unlisten = listen(uri, (found) => this.found(found));
  }

  dispose(): void {
    this.unlisten();
    this.view.destroy();
  }

  /** The text with the line ends of the file. */
  get text(): string {
    return this.view.state.doc.sliceString(0, undefined, this.lineEnd);
  }

  get isChanged(): boolean {
    return !this.view.state.doc.eq(this.first);
  }

  /** Line end of the file that is saved. */
  get ending(): string {
    return this.lineEnd === '\n' ? 'LF' : 'CRLF';
  }

  /** Replaces the text as if the user had typed it. */
  replace(text: string): void {
    this.view.dispatch({ changes: { from: 0, to: this.view.state.doc.length, insert: text } });
  }

  /** Sets the findings of a text that was opened again. */
  reopened(): void {
    this.version = 1;
    this.unchecked = [{ version: 1, doc: this.view.state.doc, since: null }];
  }

  private offset({ line, character }: Position, doc = this.view.state.doc): number {
    if (line >= doc.lines) return doc.length;
    const { from, to } = doc.line(line + 1);
    return Math.min(from + character, to);
  }

  private position(offset: number, doc = this.view.state.doc): Position {
    const line = doc.lineAt(offset);
    return { line: line.number - 1, character: offset - line.from };
  }

  private here(at = this.view.state.selection.main.head): object {
    return { textDocument: { uri: this.uri }, position: this.position(at) };
  }

  private updated(update: ViewUpdate): void {
    if (!update.docChanged) return;
    this.version += 1;
    const before = update.startState.doc;
    const changes: { range: Range; text: string }[] = [];
    update.changes.iterChanges((from, to, _, __, text) =>
      // Each position refers to the text before, so the last change is applied first.
      changes.unshift({ range: { start: this.position(from, before), end: this.position(to, before) }, text: text.sliceString(0, undefined, this.lineEnd) }),
    );
    for (const one of this.unchecked) one.since = one.since ? one.since.compose(update.changes) : update.changes;
    this.unchecked.push({ version: this.version, doc: update.state.doc, since: null });
    send({ op: 'change', uri: this.uri, version: this.version, changes });
    this.on.changed();
  }

  private found(found: Found): void {
    const own = this.unchecked.find(({ version }) => version === found.version);
    this.unchecked = this.unchecked.filter(({ version }) => version >= found.version);
    if (own) this.view.dispatch({ effects: setMarks.of({ places: found.places, doc: own.doc, since: own.since?.desc ?? null }) });
    this.on.found(found);
  }

  /** Whether the selected completion is typed already: then Enter begins a new line. */
  private isWhole(view: EditorView): boolean {
    const chosen = selectedCompletion(view.state);
    const { head } = view.state.selection.main;
    return chosen !== null && view.state.doc.lineAt(head).text.slice(0, head - view.state.doc.lineAt(head).from).endsWith(chosen.label);
  }

  /** Moves the cursor, and scrolls to it. */
  go(place: Position, isFocused = true): void {
    const at = this.offset(place);
    this.view.dispatch({ selection: EditorSelection.cursor(at), effects: EditorView.scrollIntoView(at, { y: 'center' }) });
    if (isFocused) this.view.focus();
  }

  /** Moves to the next or previous finding. */
  next(by: 1 | -1): boolean {
    const places = this.view.state.field(marks)?.places;
    if (!places?.length) return true;
    const { line, character } = this.position(this.view.state.selection.main.head);
    const all = Array.from({ length: places.length / 5 }, (_, i) => ({ line: places[i * 5]!, character: places[i * 5 + 1]! }));
    const isBehind = (one: Position): boolean => one.line > line || (one.line === line && one.character > character);
    const isBefore = (one: Position): boolean => one.line < line || (one.line === line && one.character < character);
    this.go((by > 0 ? (all.find(isBehind) ?? all[0]) : (all.findLast(isBefore) ?? all.at(-1)))!);
    return true;
  }

  search(): void {
    openSearchPanel(this.view);
  }

  /** Jumps from a mapping, a list or a header to the object; false if there is none. */
  async jump(): Promise<boolean> {
    const [to] = ((await ask('request', 'textDocument/definition', this.here())) ?? []) as Location[];
    if (to) this.go(to.range.start);
    return to !== undefined;
  }

  /** Fixes for the findings of a line. */
  async actions(range: Range, code: string): Promise<Action[]> {
    const found = await this.ask('quickfix', range);
    return found.filter(({ diagnostics }) => diagnostics?.some((one) => one.code === code)).map((one) => ({ title: one.title, edits: this.edits(one) }));
  }

  /** Applies all safe fixes; false if no finding has one. */
  async fixAll(): Promise<boolean> {
    const [action] = await this.ask('source.fixAll', { start: { line: 0, character: 0 }, end: { line: 0, character: 0 } });
    if (!action) return false;
    const resolved = action.edit ? action : ((await ask('request', 'codeAction/resolve', action)) as CodeAction);
    const edits = this.edits(resolved);
    this.apply(edits);
    return edits.length > 0;
  }

  private async ask(kind: string, range: Range): Promise<CodeAction[]> {
    const params = { textDocument: { uri: this.uri }, range, context: { diagnostics: [], only: [kind] } };
    return ((await ask('request', 'textDocument/codeAction', params)) ?? []) as CodeAction[];
  }

  private edits(action: CodeAction): TextEdit[] {
    return action.edit?.changes?.[this.uri] ?? [];
  }

  apply(edits: TextEdit[]): void {
    const { state } = this.view;
    const changes = edits.map(({ range, newText }) => ({ from: this.offset(range.start), to: this.offset(range.end), insert: state.toText(newText) }));
    const spec: TransactionSpec = { changes, userEvent: 'input.fix' };
    const first = changes[0];
    if (first) this.view.dispatch(spec, { effects: EditorView.scrollIntoView(Math.min(first.from, state.doc.length), { y: 'center' }) });
  }

  private async complete(context: CompletionContext): Promise<CompletionResult | null> {
    const list = (await ask('request', 'textDocument/completion', this.here(context.pos))) as { items: CompletionItem[] } | null;
    const first = list?.items[0];
    if (!list || !first || context.aborted) return null;
    const from = this.offset(first.textEdit.range.start);
    const options = list.items.map((item, i) => ({
      label: item.filterText || item.label,
      displayLabel: item.label,
      detail: item.detail ?? '',
      boost: -i / list.items.length,
      apply: (view: EditorView, _: unknown, start: number, end: number) => {
        const { newText } = item.textEdit;
        // Includes the text after the cursor that would be replaced.
        const behind = Math.max(end, this.offset(item.textEdit.range.end) + (view.state.selection.main.head - context.pos));
        const insert = view.state.toText(newText);
        view.dispatch({ changes: { from: start, to: behind, insert }, selection: { anchor: start + insert.length }, userEvent: 'input.complete' });
      },
      ...(item.documentation && { info: () => prose(item.documentation!.value) }),
    }));
    return { from, options, validFor: /^[^\]=\r\n]*$/ };
  }

  /** Adds a button for each fix. */
  private withFixes(dom: HTMLElement, fixes: CodeAction[]): HTMLElement {
    for (const fix of fixes) {
      const button = document.createElement('button');
      button.className = 'cm-button';
      button.textContent = fix.title.replaceAll('`', '');
      button.addEventListener('click', () => this.apply(this.edits(fix)));
      dom.append(button);
    }
    return dom;
  }

  private async hover(at: number): Promise<Tooltip | null> {
    const found = (await ask('request', 'textDocument/hover', this.here(at))) as Hover | null;
    if (!found) return null;
    const fixes = (await this.ask('quickfix', found.range ?? { start: this.position(at), end: this.position(at) })).filter(({ title }) => !title.startsWith('Allow'));
    const [pos, end] = found.range ? [this.offset(found.range.start), this.offset(found.range.end)] : [at, at];
    return { pos, end, above: true, create: () => ({ dom: this.withFixes(prose(found.contents.value), fixes) }) };
  }
}

function prose(text: string): HTMLElement {
  const dom = document.createElement('div');
  dom.className = 'od-prose';
  render(markdown(text), dom);
  return dom;
}
