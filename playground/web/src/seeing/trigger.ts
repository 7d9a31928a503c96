// A trigger waits for a frame or a value, lets the capture continue for a while, and stops it.

import { effect } from '@preact/signals-core';
import * as state from '../state';
import { reveal, trace } from '../capture';
import { readValues } from '../codec';
import { askBus, listen } from '../sim/link';
import { troubleWords } from '../sim/words';
import { parseCondition, type Condition, type ObjectCondition } from './condition';
import type { Filter } from '../trace/filter';
import { showLive } from './shelf';
import { keepLearning, mapped, valuesOf } from './signals';
import { S } from './texts';

export interface Settings {
  text: string;
  /** Milliseconds of the capture before the frame; null: all. */
  before: number | null;
  /** Milliseconds after it. */
  after: number;
}

interface Wait {
  settings: Settings;
  condition: Condition;
  /** The next frame to check. */
  next: number;
  /** The frame that triggered, and its time. */
  fired: { number: number; time: number } | null;
  /** The previous value of each source. */
  values: Map<string, number>;
}

let wait: Wait | null = null;
let isLooking = false;
let stopLearning = (): void => {};

/** Starts to wait; returns the error and its place if the condition is not valid. */
export function arm(settings: Settings): { error: string; at: number } | null {
  const condition = parseCondition(settings.text);
  if ('error' in condition) return condition;
  disarm();
  showLive();
  wait = { settings, condition, next: state.live.ring.end, fired: null, values: new Map() };
  stopLearning = 'object' in condition ? keepLearning() : stopLearning;
  tell();
  return null;
}

/** Stops waiting; a stopped capture continues. */
export function disarm(): void {
  stopLearning();
  stopLearning = () => {};
  wait = null;
  state.capturing.value = true;
  state.trigger.value = null;
}

function tell(): void {
  if (!wait) return;
  const { condition, fired, settings } = wait;
  const what = 'object' in condition ? S.trigger.value(condition.object.text) : S.trigger.frame(settings.text);
  if (!fired) state.trigger.value = { phase: 'armed', text: S.trigger.armed(what) };
  else if (state.capturing.peek()) state.trigger.value = { phase: 'fired', text: S.trigger.fired(fired.time, settings.after) };
  else state.trigger.value = { phase: 'stopped', text: S.trigger.stopped(fired.time) };
}

listen(({ now }) => void look(now));

// A step back removes frames; another bench starts without a trigger.
effect(() => {
  void state.cleared.value;
  if (!wait || !state.trigger.peek() || !state.capturing.peek()) return;
  const { end } = state.live.ring;
  wait.next = Math.min(wait.next, end);
  if (wait.fired && wait.fired.number >= end) wait.fired = null;
  tell();
});
effect(() => {
  if (state.trigger.value === null && wait) disarm();
});

/** Checks new frames, one batch at a time, since texts are requested from the worker. */
async function look(now: number): Promise<void> {
  if (isLooking || !wait || !state.capturing.peek()) return;
  isLooking = true;
  const own = wait;
  const { ring } = state.live;
  if (!own.fired && own.next < ring.end) {
    const from = Math.max(own.next, ring.first);
    const to = ring.end;
    own.next = to;
    const number = 'filter' in own.condition ? await passing(own.condition.filter, from, to) : holding(own, own.condition.object, from, to);
    const frame = number === null || wait !== own ? undefined : state.live.ring.get(number);
    if (frame) {
      own.fired = { number: number!, time: frame.time };
      tell();
    }
  }
  if (wait === own && own.fired && now >= own.fired.time + own.settings.after * 1000) stop(own, own.fired);
  isLooking = false;
}

/** The first frame that passes a filter. */
async function passing(filter: Filter, from: number, to: number): Promise<number | null> {
  const words = filter.needsWords ? await askBus('describeAll', state.live.ring.slice(from, to)) : null;
  if (filter.needsWords && !words) return null;
  const { ring } = state.live;
  for (let number = from; number < to; number++) {
    const frame = ring.get(number);
    if (frame && filter.test(frame, frame.disturbed ? troubleWords(frame) : words?.[number - from])) return number;
  }
  return null;
}

/** The first frame with a value for which the condition holds: in a PDO, or in an SDO response. */
function holding({ values }: Wait, wanted: ObjectCondition, from: number, to: number): number | null {
  const frames = state.live.ring.slice(from, to);
  const found: { source: string; at: number; value: number }[] = [];
  const add = (source: string, numbers: Float64Array): void => {
    for (let at = 0; at < numbers.length; at += 3) found.push({ source, at: numbers[at]!, value: numbers[at + 2]! });
  };
  for (const one of mapped.peek()) {
    const { object } = one;
    if (object.index !== wanted.index || object.sub !== wanted.sub || (wanted.node !== null && !one.key.startsWith(`${wanted.node} `))) continue;
    add(one.key, valuesOf(one, one.place!, frames));
  }
  state.devices.peek().forEach((device, number) => {
    const node = state.statuses.peek()[number]?.nodeId ?? device.nodeId;
    if (wanted.node !== null && wanted.node !== node) return;
    const object = device.objects.find(({ index, sub }) => index === wanted.index && sub === wanted.sub);
    add(`${node}`, readValues(frames, node, wanted.index, wanted.sub, object?.type ?? 'UNSIGNED32'));
  });
  for (const { source, at, value } of found.sort((a, b) => a.at - b.at)) {
    const before = values.get(source) ?? null;
    values.set(source, value);
    if (wanted.holds(value, before)) return from + at;
  }
  return null;
}

/** Ends the capture: later and too old frames are removed, the frame is marked and shown. */
function stop({ settings }: Wait, { number, time }: { number: number; time: number }): void {
  showLive();
  const { ring } = state.live;
  let end = number + 1;
  while (end < ring.end && ring.get(end)!.time <= time + settings.after * 1000) end += 1;
  let first = ring.first;
  while (settings.before !== null && first < number && ring.get(first)!.time < time - settings.before * 1000) first += 1;
  const marks = new Set([...state.bookmarks.peek(), number]);
  state.capturing.value = false;
  ring.truncate(end);
  ring.forgetBefore(first);
  state.captured.value = ring.end;
  state.cleared.value += 1;
  state.bookmarks.value = marks;
  trace.follow();
  reveal(number);
  tell();
}
