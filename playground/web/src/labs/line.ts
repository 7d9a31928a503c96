// The physics of the bus line: sliders, the times within a bit, and the error counters.

import { html, nothing, svg } from 'lit';
import * as state from '../state';
import { act, askBus } from '../sim/link';
import type { CableState } from '../sim/api';
import { Lab } from './lab';
import { L } from './texts';

/** Bit rate in kbit/s and longest line in metres (CiA 301, bit rates and timing). */
const LENGTHS: [number, number][] = [[1000, 25], [800, 50], [500, 100], [250, 250], [125, 500], [50, 1000], [20, 2500], [10, 5000]];
/** Width of the drawing. */
const WIDTH = 300;

class LineLab extends Lab {
  static override properties = { known: { state: true } };
  declare known: CableState | null;

  constructor() {
    super();
    this.known = null;
  }

  protected override async look(): Promise<void> {
    const known = await askBus('cable');
    if (JSON.stringify(known) !== JSON.stringify(this.known)) this.known = known;
  }

  private set(line: string): void {
    void this.play(['line real', `use ${state.selectedNode.value + 1}`, `line ${line}`]);
  }

  private slider(name: string, shown: string, value: number, [low, high, step]: [number, number, number], word: string) {
    return html`<label><span>${name}</span>
      <input type="range" aria-label=${name} aria-valuetext=${shown} min=${low} max=${high} step=${step} .value=${String(value)} @change=${(event: Event) => this.set(`${word} ${(event.target as HTMLInputElement).value}`)}>
      <output class="num">${shown}</output></label>`;
  }

  /** One bit: the sample point, and the delays that must have ended before it. */
  private bit(cable: CableState) {
    const t = L.line;
    const end = Math.max(cable.bit, cable.length ? cable.roundTrip : 0) * 1.04;
    const x = (nanos: number): number => Math.min(WIDTH, (nanos / end) * WIDTH);
    const sample = x(cable.sampleTime);
    const bar = (y: number, nanos: number, word: string) => svg`<rect x="0" y=${y} width=${x(nanos)} height="9" rx="2" class=${nanos > cable.sampleTime ? 'late' : 'early'}></rect><text x="4" y=${y + 20}>${word}</text>`;
    // Without a length there are no delays to draw.
    const low = cable.length ? 92 : 32;
    return html`<svg class="bit" viewBox="0 0 ${WIDTH} ${low + 12}" role="img" aria-label=${`${t.bit(cable.rate, cable.bit)}, ${t.sampled(cable.sampleTime)}, ${t.returns(cable.roundTrip)}`}>
      <path d=${`M0 26 V8 H${x(cable.bit)} V26`} class="edge"></path>
      <text x="4" y="22">${t.bit(cable.rate, cable.bit)}</text>
      ${cable.length ? svg`${bar(34, cable.roundTrip, t.returns(cable.roundTrip))}${bar(64, cable.settling, t.settles(cable.settling))}` : nothing}
      <path d=${`M${sample} 2 V${low}`} class="sample"></path>
      <text x=${sample - 4} y=${low + 10} text-anchor="end">${t.sampled(cable.sampleTime)}</text>
    </svg>`;
  }

  private counters() {
    const t = L.line;
    const line = state.line.value;
    const all = state.statuses.value.map((one) => ({ name: L.master.node(one.nodeId), ...one }));
    if (!line) return nothing;
    return html`<ul class="counters num" aria-label=${t.counters}>${[...all, { ...line, name: t.page }].map((one, station) => {
      const tone = one.controller === 'bus-off' ? 'bad' : one.controller === 'error passive' ? 'amber' : 'good';
      return html`<li><strong>${one.name}</strong><span>${t.tec} ${one.transmitErrors}</span><span>${t.rec} ${one.receiveErrors}</span>
        <span class="pill" data-tone=${tone}>${one.controller}</span>
        ${station < all.length ? html`<od-bus-off .node=${station}></od-bus-off>` : html`<od-bus-off></od-bus-off>`}</li>`;
    })}</ul>`;
  }

  protected override render() {
    const t = L.line;
    const cable = this.known;
    const line = state.line.value;
    if (!cable || !line) return html`<section class="lab" aria-label=${t.title}><header><h3>${t.title}</h3></header></section>`;
    const most = LENGTHS.find(([rate]) => rate === cable.rate)?.[1];
    const top = Math.max(2 * (most ?? 100), cable.length);
    const isLate = cable.length > 0 && cable.roundTrip > cable.sampleTime;
    const isSlow = cable.length > 0 && cable.settling > cable.sampleTime;
    // Without frames a wrong line shows nothing.
    const isStill = [line, ...state.statuses.value].every((one) => one.transmitErrors === 0);
    const clock = cable.clocks[state.selectedNode.value + 1] ?? 0;
    return html`<section class="lab" aria-label=${t.title}>
      <header><h3>${t.title}</h3><span class="spacer"></span><span class="muted">${t.rate} <span class="num">${cable.rate} kbit/s</span></span></header>
      <div class="sliders">
        ${this.slider(t.length, t.metres(cable.length), cable.length, [0, top, top > 1000 ? 100 : top > 100 ? 10 : 5], 'length')}
        ${this.slider(t.samplePoint, `${cable.samplePoint} %`, cable.samplePoint, [50, 95, 0.5], 'sample-point')}
        ${this.slider(t.sjw, t.quanta(cable.sjw, cable.quanta), cable.sjw, [1, 4, 1], 'sjw')}
        ${this.slider(t.clock(state.nodeId.value), t.slow(clock), clock, [-4, 4, 0.1], 'clock')}
        <div class="lab-row"><span id="lab-terminators">${t.terminators}</span><span class="segmented" role="group" aria-labelledby="lab-terminators">${[0, 1, 2, 3].map((count) => html`<button class="small" aria-pressed=${line.terminators === count} @click=${() => act({ op: 'line', real: true, terminators: count, rate: line.fixedRate })}>${count}</button>`)}</span></div>
      </div>
      ${this.counters()}
      ${this.bit(cable)}
      <p class="note" role="status" data-tone=${isLate || isSlow ? 'error' : ''}>${cable.length ? t.verdict(isLate, isSlow, cable.longest) : t.bench} ${most ? t.table(cable.rate, most) : nothing} ${t.tolerance(cable.tolerance)} ${(isLate || isSlow) && isStill ? t.traffic : nothing}</p>
    </section>`;
  }
}

customElements.define('od-line-lab', LineLab);
