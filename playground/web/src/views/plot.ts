// Numeric objects over virtual time, one chart each. The values are read in the simulation,
// once for each picture, so a plot puts nothing on the bus.

import { html } from 'lit';
import { effect, signal } from '@preact/signals-core';
import uPlot from 'uplot';
import * as state from '../state';
import type { ObjectRecord, Snapshot } from '../sim/api';
import { Series, numeric } from '../trace/series';
import { address, showValue } from '../format';
import { listen, send } from '../sim/link';
import { T } from '../texts';
import { icons } from './icons';
import { standIn } from './object-search';
import { View } from './view';

/** More would be too flat to read. */
const MOST = 4;
/** Milliseconds between two drawings. */
const PERIOD = 50;
/** What the shaft really does; not every encoder has an object for it. Index 0 is none of a dictionary's values. */
const SHAFT = standIn({ index: 0, sub: 0, name: T.plot.shaft, type: 'REAL64', bits: 64 });
/** Position, the shaft, and speed of CiA 406. */
const FIRST = [state.keyOf(0x6004, 0), state.keyOf(SHAFT.index, SHAFT.sub), state.keyOf(0x6030, 1)];

const nameOf = (object: ObjectRecord): string => (object === SHAFT ? object.name : `${address(object.index, object.sub)} ${object.name}`);

const isNumeric = (object: ObjectRecord): boolean => /^(UNSIGNED|INTEGER|REAL|BOOLEAN)/.test(object.type) && object.access !== 'wo';

/** What is plotted, by `keyOf`; the same objects of the next device, where it has them. */
const plotted = signal<readonly number[]>(FIRST);
const span = signal(10);

class Plot extends View {
  private series = new Series(0);
  private shown: ObjectRecord[] = [];
  private charts: uPlot[] = [];
  private built = '';
  private timer = 0;
  private ends: (() => void)[] = [];
  private readonly resized = new ResizeObserver(() => this.fit());

  override connectedCallback(): void {
    super.connectedCallback();
    this.ends = [
      listen((snapshot) => this.take(snapshot)),
      // A worker that was started again knows nothing of what is plotted.
      effect(() => {
        if (state.health.value === 'running') this.choose();
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
    this.drop();
    send({ op: 'plot', addresses: [] });
  }

  /** Asks for the values of what is plotted, and begins from nothing. */
  private choose(): void {
    const objects = state.objectsByKey.value;
    void state.selectedNode.value;
    this.shown = plotted.value.map((key) => (key === 0 ? SHAFT : objects.get(key))).filter((object) => object !== undefined && isNumeric(object)) as ObjectRecord[];
    this.series = new Series(this.shown.length);
    send({ op: 'plot', addresses: this.shown.map(({ index, sub }) => ({ index, sub })) });
    this.requestUpdate();
  }

  private take({ now, nodes, plot }: Snapshot): void {
    if (!plot || plot.node !== state.selectedNode.peek() || plot.addresses.length !== this.shown.length) return;
    if (!plot.addresses.every(({ index, sub }, i) => this.shown[i]?.index === index && this.shown[i].sub === sub)) return;
    const rpm = nodes[plot.node]?.shaft?.rpm ?? null;
    this.series.push(now / 1e6, plot.values.map((value, i) => (this.shown[i] === SHAFT ? rpm && Math.round(rpm * 1000) / 1000 : numeric(value))));
    this.timer ||= window.setTimeout(() => {
      this.timer = 0;
      this.requestUpdate();
    }, PERIOD);
  }

  /** The virtual seconds that are drawn. */
  private window(): [number, number] {
    const last = this.series.times.at(-1) ?? 0;
    const from = span.value ? Math.max(0, last - span.value) : (this.series.times[0] ?? 0);
    return [from, Math.max(last, from + 0.001)];
  }

  private drop(): void {
    for (const chart of this.charts) chart.destroy();
    this.charts = [];
    this.built = '';
  }

  private build(): void {
    const wanted = this.shown.map(({ index, sub }) => state.keyOf(index, sub)).join(' ');
    if (wanted === this.built) return;
    this.drop();
    this.built = wanted;
    this.charts = [...this.querySelectorAll<HTMLElement>('.plot-area')].map((area) => {
      // The colours follow the theme: they are asked for at every drawing.
      const style = getComputedStyle(area);
      const axis = { stroke: () => style.borderTopColor, grid: { stroke: () => style.outlineColor, width: 1 }, ticks: { show: false }, font: `11px ${style.fontFamily}` };
      return new uPlot(
        {
          width: area.clientWidth || 300,
          height: area.clientHeight || 100,
          legend: { show: false },
          cursor: { sync: { key: 'odkit' }, drag: { x: false, y: false } },
          scales: { x: { time: false, range: () => this.window() } },
          axes: [
            { ...axis, size: 24, values: (_, ticks) => ticks.map((tick) => `${+tick.toFixed(6)} s`) },
            { ...axis, size: 76, values: (_, ticks) => ticks.map((tick) => tick.toLocaleString('en').replaceAll(',', '\u2009')) },
          ],
          series: [{}, { stroke: () => style.color, width: 1, points: { show: false } }],
        },
        [[], []],
        area,
      );
    });
  }

  private fit(): void {
    this.querySelectorAll<HTMLElement>('.plot-area').forEach((area, i) => this.charts[i]?.setSize({ width: area.clientWidth, height: area.clientHeight }));
  }

  protected override updated(): void {
    const before = this.charts.length;
    this.build();
    if (this.charts.length !== before) this.fit();
    this.charts.forEach((chart, i) => chart.setData([this.series.times, this.series.columns[i] ?? []]));
  }

  private add(event: Event): void {
    const select = event.target as HTMLSelectElement;
    if (select.value) plotted.value = [...this.shown.map(({ index, sub }) => state.keyOf(index, sub)), Number(select.value)];
    select.value = '';
  }

  private figure(object: ObjectRecord, i: number) {
    const t = T.plot;
    const name = nameOf(object);
    const { last, least, most } = this.series.range(i, this.window()[0]);
    const range = least <= most ? t.range(showValue(least, object), showValue(most, object)) : '';
    return html`<figure class="plot">
      <figcaption><i></i><b>${name}</b><span class="num" aria-label=${`${name} now`}>${showValue(last, object)}</span><span class="spacer"></span><span class="num muted">${range}</span>
        <button class="icon-button" aria-label=${t.remove(name)} title=${t.remove(name)} @click=${() => (plotted.value = plotted.value.filter((key) => key !== state.keyOf(object.index, object.sub)))}>${icons.close}</button></figcaption>
      <div class="plot-area" role="img" aria-label=${`${name}: ${range}`}></div>
    </figure>`;
  }

  protected override render() {
    const t = T.plot;
    const isShown = new Set(this.shown);
    const others = [SHAFT, ...(state.device.value?.objects ?? [])].filter((object) => isNumeric(object) && !isShown.has(object));
    return html`<div class="plot-bar">
        <label class="select bordered grow"><select aria-label=${t.add} ?disabled=${this.shown.length >= MOST} @change=${(event: Event) => this.add(event)}>
          <option value="">${t.add}</option>
          ${others.map((object) => html`<option value=${state.keyOf(object.index, object.sub)}>${nameOf(object)}${object.parent ? ` (${object.parent})` : ''}</option>`)}
        </select></label>
        <label class="select bordered"><select aria-label=${t.window} @change=${(event: Event) => (span.value = Number((event.target as HTMLSelectElement).value))}>
          ${[1, 10, 60, 0].map((seconds) => html`<option value=${seconds} ?selected=${seconds === span.value}>${t.windows[seconds]}</option>`)}
        </select></label>
      </div>
      <div class="plots scroll" role="region" aria-label=${t.region} tabindex="0">
        ${this.shown.length ? this.shown.map((object, i) => this.figure(object, i)) : html`<p class="empty">${t.nothing}</p>`}
      </div>`;
  }
}

customElements.define('od-plot', Plot);
