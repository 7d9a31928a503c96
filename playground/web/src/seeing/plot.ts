// Values over virtual time: objects in the frames of the capture, and objects of the simulation. A plot
// sends nothing.

import { html, nothing } from 'lit';
import { effect, signal } from '@preact/signals-core';
import * as state from '../state';
import { download } from '../actions';
import { grouped, showValue } from '../format';
import { icons } from '../views/icons';
import { View } from '../views/view';
import { Charts, type Cursors } from './charts';
import { csv, png } from './export';
import { keepLearning, live, mapped, type Plottable } from './signals';
import './style';
import { S } from './texts';
import { isLog } from './log';
import { follow, inFull, plotted } from './tracks';

/** Maximum number of areas; more would be too flat to read. */
const MOST = 6;
/** Milliseconds between two refreshes. */
const PERIOD = 50;

// The choices of the user stay when the plot is closed.
const seconds = signal(10);
const isShared = signal(false);
const cursors = signal<Cursors>({ a: null, b: null });

/** Values of the simulation. A log has only those of its own frames. */
const sources = (): Plottable[] => (isLog() ? [] : live());

class Plot extends View {
  private readonly charts = new Charts(() => this.window(), () => cursors.peek(), (at) => this.choose(at));
  private timer = 0;
  private ends: (() => void)[] = [];
  private readonly resized = new ResizeObserver(() => this.charts.fit());

  override connectedCallback(): void {
    super.connectedCallback();
    this.ends = [
      keepLearning(),
      effect(() => {
        void state.now.value;
        void state.captured.value;
        this.timer ||= window.setTimeout(() => {
          this.timer = 0;
          this.requestUpdate();
        }, PERIOD);
      }),
    ];
    this.resized.observe(this);
  }

  override disconnectedCallback(): void {
    super.disconnectedCallback();
    for (const end of this.ends) end();
    this.resized.disconnect();
    clearTimeout(this.timer);
    this.timer = 0;
    this.charts.drop();
  }

  /** The plotted and the available values: the devices may have changed. */
  private shown(): Plottable[] {
    const all = new Map([...sources(), ...mapped.value].map((one) => [one.key, one]));
    return plotted.value.flatMap((key) => all.get(key) ?? []).slice(0, MOST);
  }

  /** Range of virtual seconds that is drawn. A paused console pauses the plot, too. */
  private window(): [number, number] {
    const { ring } = state;
    const all = this.shown().map(follow);
    const newest = Math.max(0, ...all.map(({ times }) => times.at(-1) ?? 0));
    const held = state.pausedAt.peek();
    const last = held === null ? newest : (ring.get(Math.max(held - 1, ring.first))?.time ?? newest * 1e6) / 1e6;
    const first = Math.min(last, ...all.map(({ times }) => times[0] ?? last));
    const from = seconds.value ? Math.max(first, last - seconds.value) : first;
    return [from, Math.max(last, from + 0.001)];
  }

  /** The first click sets cursor A, the second B; later clicks move the nearer one. */
  private choose(at: number): void {
    const { a, b } = cursors.value;
    const isA = a === null || (b !== null && Math.abs(at - a) <= Math.abs(at - b));
    this.set(isA ? 'a' : 'b', at);
  }

  private set(name: 'a' | 'b', at: number | null): void {
    cursors.value = { ...cursors.value, [name]: at === null || Number.isNaN(at) ? null : Math.round(at * 1e6) / 1e6 };
    this.charts.draw();
  }

  protected override updated(): void {
    const shown = this.shown();
    const swatches = [...this.querySelectorAll<HTMLElement>('figcaption i')];
    const lines = shown.map((one, i) => ({ series: follow(one), swatch: swatches[i]! }));
    const name = `${isShared.value} ${shown.map(({ key }) => key).join('|')}`;
    this.charts.build(name, [...this.querySelectorAll<HTMLElement>('.plot-area')], isShared.value ? [lines] : lines.map((line) => [line]));
    this.charts.fit();
    this.charts.draw();
  }

  private add(event: Event): void {
    const select = event.target as HTMLSelectElement;
    if (select.value) plotted.value = [...this.shown().map(({ key }) => key), select.value];
    select.value = '';
  }

  private saveCsv(): void {
    download(csv(this.shown().map((one) => ({ name: one.name, series: inFull(one) }))), 'odkit-plot.csv');
  }

  private async savePng(): Promise<void> {
    const style = getComputedStyle(this);
    const shown = this.shown().map(({ name }, i) => ({ text: name, colour: getComputedStyle(this.querySelectorAll('figcaption i')[i]!).backgroundColor }));
    const panels = this.charts.canvases().map((canvas, i) => ({ canvas, captions: isShared.value ? shown : shown.slice(i, i + 1) }));
    download(await png(panels, style, getComputedStyle(this.closest('.panel')!).backgroundColor), 'odkit-plot.png');
  }

  private caption(one: Plottable, i: number) {
    const t = S.plot;
    const series = follow(one);
    const last = series.values.at(-1) ?? null;
    const range = this.range(one);
    return html`<figcaption data-line=${i}><i></i><b>${one.name}</b><span class="num" aria-label=${`${one.name} now`}>${showValue(last, one.object)}</span><span class="spacer"></span><span class="num muted">${range}</span>
      <button class="icon-button" aria-label=${t.remove(one.name)} title=${t.remove(one.name)} @click=${() => (plotted.value = plotted.value.filter((key) => key !== one.key))}>${icons.close}</button></figcaption>`;
  }

  private range(one: Plottable): string {
    const { least, most } = follow(one).range(...this.window());
    return least <= most ? S.plot.range(showValue(least, one.object), showValue(most, one.object)) : '';
  }

  private figures(shown: Plottable[]) {
    const area = (title: string) => html`<div class="plot-area" role="img" aria-label=${title}></div>`;
    const title = (one: Plottable): string => `${one.name}: ${this.range(one)}`;
    if (isShared.value) return html`<figure class="plot shared">${shown.map((one, i) => this.caption(one, i))}${area(shown.map(title).join('; '))}</figure>`;
    return shown.map((one, i) => html`<figure class="plot" data-line=${i}>${this.caption(one, i)}${area(title(one))}</figure>`);
  }

  private field(name: 'a' | 'b') {
    const at = cursors.value[name];
    return html`<label>${S.plot.cursor(name.toUpperCase())} <input class="num" type="number" step="any" aria-label=${S.plot.cursorAt(name.toUpperCase())} .value=${at === null ? '' : String(at)}
      @change=${(event: Event) => this.set(name, (event.target as HTMLInputElement).valueAsNumber)}> s</label>`;
  }

  /** Values at the cursors, and their differences. */
  private differences(shown: Plottable[]) {
    const t = S.plot;
    const { a, b } = cursors.value;
    if (a === null && b === null) return nothing;
    const cell = (value: number | null, { object }: Plottable) => html`<td class="num">${value === null ? '' : showValue(value, object)}</td>`;
    const rows = shown.map((one) => {
      const series = follow(one);
      const [from, to] = [a, b].map((time) => (time === null ? null : series.at(time))) as [number | null, number | null];
      const change = from === null || to === null ? '' : signed(to - from);
      return html`<tr><th scope="row">${one.name}</th>${cell(from, one)}${cell(to, one)}<td class="num">${change}</td></tr>`;
    });
    const span = a === null || b === null ? '' : signed(b - a);
    return html`<table class="cursors" aria-label=${t.cursors}>
      <thead><tr><th scope="col">${t.value}</th><th scope="col">A</th><th scope="col">B</th><th scope="col">Δ</th></tr></thead>
      <tbody>${rows}<tr><th scope="row">${t.time}</th><td class="num">${a ?? ''}</td><td class="num">${b ?? ''}</td><td class="num">${span}</td></tr></tbody>
    </table>`;
  }

  protected override render() {
    const t = S.plot;
    const shown = this.shown();
    const isShown = new Set(shown.map(({ key }) => key));
    const option = (one: Plottable) => (isShown.has(one.key) ? nothing : html`<option value=${one.key}>${one.name}${one.object.parent && !one.place ? ` (${one.object.parent})` : ''}</option>`);
    const hasCursor = cursors.value.a !== null || cursors.value.b !== null;
    return html`<div class="plot-bar">
        <label class="select bordered grow"><select aria-label=${t.add} ?disabled=${shown.length >= MOST} @change=${(event: Event) => this.add(event)}>
          <option value="">${t.add}</option>
          ${mapped.value.length ? html`<optgroup label=${t.fromFrames}>${mapped.value.map(option)}</optgroup>` : nothing}
          ${sources().length ? html`<optgroup label=${t.live}>${sources().map(option)}</optgroup>` : nothing}
        </select></label>
        <label class="select bordered"><select aria-label=${t.window} @change=${(event: Event) => (seconds.value = Number((event.target as HTMLSelectElement).value))}>
          ${[1, 10, 60, 0].map((span) => html`<option value=${span} ?selected=${span === seconds.value}>${t.windows[span]}</option>`)}
        </select></label>
        <span class="segmented" role="group" aria-label=${t.axes}>
          <button class="small" aria-pressed=${!isShared.value} @click=${() => (isShared.value = false)}>${t.own}</button>
          <button class="small" aria-pressed=${isShared.value} @click=${() => (isShared.value = true)}>${t.shared}</button>
        </span>
        <button class="small" ?disabled=${!shown.length} aria-label=${t.csv} title=${t.csv} @click=${() => this.saveCsv()}>${icons.save} CSV</button>
        <button class="small" ?disabled=${!shown.length} aria-label=${t.png} title=${t.png} @click=${() => void this.savePng()}>${icons.save} PNG</button>
      </div>
      <div class="plots scroll" role="region" aria-label=${t.region} tabindex="0">
        ${shown.length ? this.figures(shown) : html`<p class="empty">${t.nothing}</p>`}
      </div>
      ${shown.length
        ? html`<div class="plot-bar" role="group" aria-label=${t.cursors}>${this.field('a')}${this.field('b')}
            ${hasCursor ? html`<button class="small quiet" @click=${() => { cursors.value = { a: null, b: null }; }}>${t.noCursors}</button>` : html`<span class="muted">${t.howCursors}</span>`}
          </div>${this.differences(shown)}`
        : nothing}`;
  }
}

/** A difference, with its sign. */
const signed = (value: number): string => `${value > 0 ? '+' : value < 0 ? '−' : ''}${Number.isInteger(value) ? grouped(Math.abs(value)) : +Math.abs(value).toFixed(6)}`;

customElements.define('od-plot', Plot);
