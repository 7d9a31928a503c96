// Plays a log: onto the bus, where devices respond, or only in the console.

import { html, nothing } from 'lit';
import { signal } from '@preact/signals-core';
import { setRunning } from '../actions';
import { grouped } from '../format';
import { ask, listen, send } from '../sim/link';
import { FRAME_BYTES, unpack } from '../sim/packed';
import * as state from '../state';
import type { Ring } from '../trace/ring';
import { icons } from '../views/icons';
import { View } from '../views/view';
import { beside, show, showLive } from './shelf';
import './style';
import { S } from './texts';

type Way = keyof typeof S.player.ways;

const way = signal<Way>('bus');
const speed = signal(1);
const phase = signal<'ready' | 'runs' | 'held'>('ready');
/** Number of frames that were sent or shown. */
const place = signal(0);

/** Milliseconds between two checks of the clock. */
const TICK = 30;
let timer = 0;
/** Current moment of a log in the console, in microseconds. */
let at = 0;
/** The worker has the frames, and reports its progress. */
let isUnderWay = false;

const timeOf = (number: number): number => unpack(state.log.peek()!.frames, number * FRAME_BYTES).time;

/** Location of the log: beside the capture, or in its place. */
function ring(): Ring {
  const log = beside.peek();
  return log && !log.isShown ? log.ring : state.ring;
}

/** Starts at the first frame, or before it if it is paused. */
export function start(where: Way, isHeld = false): void {
  const log = state.log.peek();
  if (!log?.count) return;
  end();
  // A log is never sent to a real bus.
  if (state.real.peek()) where = 'look';
  way.value = where;
  place.value = 0;
  phase.value = isHeld ? 'held' : 'runs';
  if (where === 'bus') {
    showLive();
    isUnderWay = false;
    void ask((ticket) => ({ op: 'replay', ticket, frames: log.frames, speed: speed.peek(), paused: isHeld }), false).then((begun) => (isUnderWay = begun));
    if (!isHeld) setRunning(true);
    return;
  }
  show(true);
  if (!beside.peek()) setRunning(false);
  ring().clear();
  state.cleared.value += 1;
  at = timeOf(0);
  if (!isHeld) tick();
}

function hold(isHeld: boolean): void {
  phase.value = isHeld ? 'held' : 'runs';
  if (way.peek() === 'bus') {
    send({ op: 'player', paused: isHeld });
    if (!isHeld) setRunning(true);
  } else if (isHeld) clearTimeout(timer);
  else tick();
}

function step(): void {
  if (phase.peek() === 'ready') start(way.peek(), true);
  if (phase.peek() === 'runs') hold(true);
  if (way.peek() === 'bus') send({ op: 'player', steps: true });
  else if (place.peek() < state.log.peek()!.count) fill(place.peek() + 1);
}

/** Shows the frames up to this number, excluding it. */
function fill(to: number): void {
  const { frames, count } = state.log.peek()!;
  ring().append(frames.subarray(place.peek() * FRAME_BYTES, to * FRAME_BYTES));
  place.value = to;
  at = Math.max(at, to > 0 ? timeOf(to - 1) : at);
  state.captured.value = state.ring.end;
  if (to === count) phase.value = 'ready';
}

function tick(): void {
  const since = performance.now();
  clearTimeout(timer);
  timer = window.setTimeout(() => {
    if (phase.peek() !== 'runs' || !state.log.peek()) return;
    at += (performance.now() - since) * 1000 * speed.peek();
    let to = place.peek();
    while (to < state.log.peek()!.count && timeOf(to) <= at) to += 1;
    if (to > place.peek()) fill(to);
    if (phase.peek() === 'runs') tick();
  }, TICK);
}

/** Stops: the remaining frames are not sent; a log in the console is shown completely. */
function end(): void {
  clearTimeout(timer);
  if (phase.peek() !== 'ready' && way.peek() === 'bus') send({ op: 'player', ends: true });
  if (phase.peek() !== 'ready' && way.peek() === 'look') fill(state.log.peek()!.count);
  phase.value = 'ready';
}

/** Replaces the log by another one, or by none. */
export function forget(): void {
  clearTimeout(timer);
  if (phase.peek() !== 'ready' && way.peek() === 'bus') send({ op: 'player', ends: true });
  phase.value = 'ready';
  place.value = 0;
}

listen(({ toSend }) => {
  const log = state.log.peek();
  if (!log || !isUnderWay || phase.peek() === 'ready' || way.peek() !== 'bus') return;
  place.value = log.count - toSend;
  if (toSend === 0) phase.value = 'ready';
});

class Player extends View {
  private speed(event: Event): void {
    const value = (event.target as HTMLInputElement).valueAsNumber;
    speed.value = value > 0 ? Math.min(value, 1000) : 1;
    if (phase.value !== 'ready' && way.value === 'bus') send({ op: 'player', speed: speed.value });
  }

  protected override render() {
    const log = state.log.value;
    if (!log) return nothing;
    const t = S.player;
    const isReady = phase.value === 'ready';
    const main = isReady ? t.start : phase.value === 'runs' ? t.hold : t.goOn;
    const run = (): void => (isReady ? start(way.value) : hold(phase.value === 'runs'));
    const shown = Math.min(Math.max(0, place.value - 1), log.count - 1);
    const time = log.count ? (timeOf(shown) - timeOf(0)) / 1e6 : 0;
    return html`<div class="player" role="group" aria-label=${t.title(log.name)}>
      <b>${log.name}</b>
      <label class="select bordered"><select aria-label=${t.way} ?disabled=${!isReady} @change=${(event: Event) => (way.value = (event.target as HTMLSelectElement).value as Way)}>
        ${(Object.keys(t.ways) as Way[]).map((one) => html`<option value=${one} ?selected=${one === way.value}>${t.ways[one]}</option>`)}
      </select></label>
      <label class="every"><input class="num" type="number" min="0.001" max="1000" step="any" aria-label=${t.speed} .value=${String(speed.value)} @change=${(event: Event) => this.speed(event)}> ×</label>
      <button class="icon-button" aria-label=${main} title=${main} @click=${run}>${phase.value === 'runs' ? icons.pause : icons.play}</button>
      <button class="icon-button" aria-label=${t.step} title=${t.step} @click=${step}>${icons.stepFrame}</button>
      <button class="icon-button" aria-label=${t.end} title=${t.end} ?disabled=${isReady} @click=${end}>${icons.back}</button>
      <progress aria-label=${t.progress} max=${log.count} .value=${place.value}></progress>
      <span class="num muted">${t.place(grouped(place.value), grouped(log.count), time.toFixed(3))}</span>
      <button class="icon-button" aria-label=${t.remove} title=${t.remove} @click=${() => { end(); forget(); state.log.value = null; }}>${icons.close}</button>
    </div>`;
  }
}

customElements.define('od-player', Player);
