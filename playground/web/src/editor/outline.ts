// The sections of a text as a list that can be searched.

import { html } from 'lit';
import { ask } from './client';
import { E } from './texts';
import { Rows, setText } from '../views/rows';
import { View } from '../views/view';

/** Delay in ms after a change before the list is updated. */
const REST = 400;

class Outline extends View {
  static override properties = { query: { state: true } };
  declare query: string;
  uri = '';
  go: (line: number) => void = () => {};
  private names: string[] = [];
  private lines = new Uint32Array(0);
  private depths = new Uint8Array(0);
  private shown: number[] = [];
  private rows: Rows | undefined;
  private timer = 0;

  constructor() {
    super();
    this.query = '';
  }

  /** The text was replaced or changed. */
  refresh(): void {
    clearTimeout(this.timer);
    this.timer = window.setTimeout(() => void this.load(), this.names.length ? REST : 0);
  }

  private async load(): Promise<void> {
    const made = await ask('outline', this.uri).catch(() => null);
    if (!made) return;
    this.names = made.names ? made.names.split('\n') : [];
    this.lines = Uint32Array.from(made.lines);
    this.depths = Uint8Array.from(made.depths);
    this.filter();
  }

  private filter(): void {
    const wanted = this.query.trim().toLowerCase();
    this.shown = [...this.names.keys()].filter((i) => this.names[i]!.toLowerCase().includes(wanted));
    this.rows?.redraw();
  }

  protected override firstUpdated(): void {
    this.rows = new Rows(this.querySelector<HTMLElement>('.outline-rows')!, {
      count: () => this.shown.length,
      make: () => {
        const row = document.createElement('button');
        row.className = 'quiet outline-row';
        row.addEventListener('click', () => this.go(Number(row.dataset['line'])));
        return row;
      },
      fill: (row, index) => {
        const number = this.shown[index]!;
        setText(row, this.names[number]!);
        row.title = this.names[number]!;
        row.dataset['line'] = String(this.lines[number]);
        row.dataset['depth'] = String(this.depths[number]);
      },
    });
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    clearTimeout(this.timer);
    this.rows?.dispose();
  }

  protected override render() {
    return html`<input type="search" aria-label=${E.outline.search} placeholder=${E.outline.hint} .value=${this.query}
        @input=${(event: Event) => { this.query = (event.target as HTMLInputElement).value; this.filter(); }}>
      <div class="outline-rows scroll" role="group" aria-label=${E.outline.list}></div>`;
  }
}

customElements.define('od-outline', Outline);
declare global {
  interface HTMLElementTagNameMap {
    'od-outline': Outline;
  }
}
