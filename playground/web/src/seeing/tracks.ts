// The values of plots. They stay when a plot is closed: values in frames come from the whole
// capture, values of the simulation are recorded from the start of the page.

import { effect, signal } from '@preact/signals-core';
import * as state from '../state';
import { listen, send } from '../sim/link';
import type { Snapshot } from '../sim/api';
import { numeric, Series } from './series';
import { live, valuesOf, type Plottable } from './signals';

/** Position, the shaft, and speed of CiA 406. */
const FIRST = [String(state.keyOf(0x6004, 0)), '0', String(state.keyOf(0x6030, 1))];

/** Keys of the plotted values; the next device uses the same objects, if it has them. */
export const plotted = signal<readonly string[]>(FIRST);

/** Values of the simulation, by device and key. */
const recorded = new Map<string, Series>();
/** Values in frames, as far as the capture was decoded. */
const decoded = new Map<string, { place: string; cleared: number; next: number; series: Series }>();

let asked: Plottable[] = [];

/** Records the default values and the chosen ones. */
export function start(): void {
  effect(() => {
    const keys = new Set([...FIRST, ...plotted.value]);
    asked = live().filter(({ key }) => keys.has(key));
    // A restarted worker does not have the list.
    if (state.health.value === 'running') send({ op: 'plot', addresses: asked.map(({ object: { index, sub } }) => ({ index, sub })) });
  });
  effect(() => {
    void state.cleared.value;
    if (state.ring.first === state.ring.end) recorded.clear();
  });
  listen(take);
}

function seriesOf(device: number, key: string): Series {
  const name = `${device} ${key}`;
  const known = recorded.get(name) ?? new Series();
  recorded.set(name, known);
  return known;
}

function take({ now, nodes, plot }: Snapshot): void {
  if (!plot || plot.addresses.length !== asked.length) return;
  plot.addresses.forEach(({ index, sub }, i) => {
    const { key, object } = asked[i]!;
    if (object.index !== index || object.sub !== sub) return;
    const rpm = nodes[plot.node]?.shaft?.rpm;
    const value = index === 0 ? (rpm === undefined ? null : Math.round(rpm * 1000) / 1000) : numeric(plot.values[i]);
    const series = seriesOf(plot.node, key);
    // A moment has one value.
    if (series.times.at(-1) === now / 1e6) series.values[series.values.length - 1] = value;
    else series.push(now / 1e6, value);
  });
}

/** All values of a source, up to now. */
export function follow(what: Plottable): Series {
  if (!what.place) return seriesOf(state.selectedNode.peek(), what.key);
  const { ring } = state;
  const place = JSON.stringify(what.place);
  const cleared = state.cleared.peek();
  let track = decoded.get(what.key);
  if (!track || track.place !== place || track.cleared !== cleared || track.next > ring.end) {
    track = { place, cleared, next: ring.first, series: new Series() };
    decoded.set(what.key, track);
  }
  fill(track.series, what, Math.max(track.next, ring.first));
  track.next = ring.end;
  return track.series;
}

function fill(series: Series, what: Plottable, from: number): void {
  const found = valuesOf(what, what.place!, state.ring.slice(from, state.ring.end));
  for (let at = 0; at < found.length; at += 3) series.push(found[at + 1]! / 1e6, found[at + 2]!);
}

/** Like `follow`, with each value of the capture: old values are not thinned out. */
export function inFull(what: Plottable): Series {
  if (!what.place) return follow(what);
  const series = new Series(Infinity);
  fill(series, what, state.ring.first);
  return series;
}
