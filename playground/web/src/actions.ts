// All actions of a user.

import type { Input, Source } from './sim/api';
import { readLine, type ReadLine, type Typed } from './codec';
import { act, add, describe, dropFrames, restore, select, send, takeBack, use } from './sim/link';
import * as state from './state';
import { parseAddress } from './views/object-search';
import { T } from './texts';

export function sendFrame(frame: Typed): void {
  const { id, data, extended, remote } = frame;
  act({ op: 'send', id, data, extended, remote });
}

/** The meaning of a line, for the selected node. An object alone (`6004`, `1018:4`, its name) is read. */
export function readTyped(text: string): ReadLine {
  const read = (line: string): ReadLine => readLine(line, state.nodeId.value, (index, sub) => state.objectsByKey.value.get(state.keyOf(index, sub)));
  const parsed = read(text);
  if ('frame' in parsed) return parsed;
  const wanted = text.trim().toLowerCase();
  const where = /^(0x)?[0-9a-f]{4}h?(\s*[:./]\s*[0-9a-f]{1,2}h?)?$/i.test(wanted) ? parseAddress(wanted) : state.device.value?.objects.find(({ name }) => name.toLowerCase() === wanted);
  if (!wanted || !where) return parsed;
  const hex = (value: number): string => value.toString(16);
  return read(`read ${hex(where.index).padStart(4, '0')}:${hex(where.sub).padStart(2, '0')}`);
}

/** Sends the frame of a line, for the selected node: `nmt start`, `601#40 04 60 00`. */
export function sendLine(line: string): void {
  const parsed = readTyped(line);
  if ('frame' in parsed) sendFrame(parsed.frame);
}

/** Returns whether a line is an action outside the bus: `power off`, `set 6000h:01 = 5`. */
export const isDeed = (line: string): boolean => !state.real.value && /^\s*(power|shaft|switch|fault|bus|line|set|emcy|pin|wire|master)\s/.test(line);

/** Does such an action on the selected device. */
export async function doLine(line: string): Promise<void> {
  const { diagnostics } = await add({ op: 'script', text: `use ${state.selectedNode.value + 1}\n${line}` });
  // The place is left out: it is line 2 of this script, and the user typed one line.
  if (diagnostics[0]) state.toast.value = { text: diagnostics[0].message.replace(/^line 2 [^\n]*\n\s*|^2:\d+: /, ''), tone: 'error' };
}

export function setPower(on: boolean): void {
  act({ op: 'power', node: state.selectedNode.value, on });
}

/** Turns the shaft to a number of revolutions; it stops there. */
export function turnTo(turns: number): void {
  if (state.shaft.value?.rpm || state.status.value?.moves) setRpm(0);
  act({ op: 'turn', node: state.selectedNode.value, turns });
}

export function setRpm(rpm: number): void {
  act({ op: 'rpm', node: state.selectedNode.value, rpm });
}

export function setRunning(running: boolean): void {
  state.running.value = running;
  send({ op: 'run', running });
}

export function setSpeed(factor: number): void {
  state.speed.value = factor;
  send({ op: 'speed', factor });
}

/** Lets this time pass; with `frames`, the time that this number of frames needs. */
export function step(micros: number, frames = 0): void {
  setRunning(false);
  send({ op: 'step', micros, frames });
}

/** Goes back to the moment before the newest frame. */
export function stepBack(): void {
  setRunning(false);
  const { ring } = state.live;
  const newest = ring.get(ring.end - 1)?.time;
  send({ op: 'back', to: (newest ?? state.now.value) - 1 });
}

export function togglePause(): void {
  state.pausedAt.value = state.pausedAt.value === null ? state.ring.end : null;
}

export function clearConsole(): void {
  state.ring.clear();
  state.chosenFrame.value = null;
  if (state.pausedAt.value !== null) state.pausedAt.value = state.ring.end;
  state.captured.value = state.ring.end;
  state.cleared.value += 1;
}

/** Saves the capture in a format of other tools. */
export async function saveLog(format: string, frames = state.ring.slice(state.ring.first, state.ring.end)): Promise<void> {
  if (frames.length === 0) {
    state.toast.value = { text: T.frames.noFrames, tone: 'info' };
    return;
  }
  const file = await use('writeLog', format, frames);
  if ('value' in file) download(file.value as Uint8Array<ArrayBuffer>, `odkit-${state.device.value?.name ?? 'capture'}.${format}`);
}

/** Downloads a file. */
export function download(content: string | Uint8Array<ArrayBuffer>, name: string): void {
  const url = URL.createObjectURL(new Blob([content], { type: typeof content === 'string' ? 'text/plain' : 'application/octet-stream' }));
  const link = document.createElement('a');
  link.href = url;
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}

/**
 * Puts a device on the bus, in the place of another or in a new one. Returns its number. If its file cannot be used, returns
 * null and the reason, which is empty if the report of the file has it. Reports a replaced device, unless `told` is false.
 */
export async function openDevice(source: Source, nodeId: number, place: number | 'new' = state.selectedNode.value, told = true): Promise<{ node: number | null; why: string }> {
  const before = place === 'new' ? undefined : state.devices.value[place];
  const input: Input = { op: 'add', source, nodeId, ...(before && { place: Number(place) }) };
  const { node, diagnostics, entry } = await (state.real.value && state.describes.value ? describe(input) : add(input));
  if (node === null) return { node, why: diagnostics[0]?.message ?? '' };
  if (node !== state.selectedNode.value) select(node);
  if (before && entry !== undefined && !state.real.value) {
    const { name } = before;
    state.replaced.value = { name, entry };
    if (told) state.toast.value = { text: T.dialog.replaced(name, state.devices.value[node]?.name ?? source.name), tone: 'info', action: { text: T.dialog.undo(name), run: () => void undoReplace() } };
  }
  remember();
  return { node, why: '' };
}

/** Restores the bench to the moment before a device was replaced. */
export async function undoReplace(): Promise<void> {
  const before = state.replaced.value;
  state.report.value = null;
  if (before) await takeBack(before.entry);
  remember();
}

/** Takes a device off the bus. */
export function removeDevice(node: number): void {
  act({ op: 'remove', node });
  select(Math.max(0, Math.min(state.selectedNode.value, state.devices.value.length - 2)));
  remember();
}

export const MOST_NODES = 4;

/** The address that opens these devices again, and the lab: `#device=gxmm&node=1&device=gxam&node=2&lab=line`. */
export function remember(): void {
  if (state.real.value) return;
  const parts = new URLSearchParams();
  for (const { source, nodeId, name } of state.devices.value) {
    // The further channels of an encoder are added with its first one.
    if (source.kind !== 'builtin' || name !== source.name) continue;
    parts.append('device', source.name);
    parts.append('node', String(nodeId));
  }
  if (state.lab.value) parts.set('lab', state.lab.value);
  history.replaceState(null, '', parts.size ? `#${parts}` : location.pathname + location.search);
}

/** The devices of the address; one gxmm if it names none. */
export function recall(): { source: Source; nodeId: number }[] {
  const parts = new URLSearchParams(location.hash.slice(1));
  const nodes = parts.getAll('node').map(Number);
  const all = parts.getAll('device');
  const names = all.slice(0, MOST_NODES);
  if (all.length > MOST_NODES) state.toast.value = { text: T.app.tooMany(MOST_NODES, all.length), tone: 'error' };
  return (names.length ? names : ['gxmm']).map((name, i) => {
    const node = nodes[i] ?? i + 1;
    return {
      source: { kind: 'builtin', name: name.slice(0, 40) },
      nodeId: Number.isInteger(node) && node >= 1 && node <= 127 ? node : 1,
    };
  });
}

/** A fresh bench with these devices. */
export async function begin(wanted: { source: Source; nodeId: number }[]): Promise<void> {
  restore([], 0);
  for (const { source, nodeId } of wanted) {
    if ((await openDevice(source, nodeId, 'new')).node !== null) continue;
    state.toast.value = { text: T.app.noDevice(source.name), tone: 'error' };
    if (state.devices.value.length === 0) await openDevice({ kind: 'builtin', name: 'gxmm' }, nodeId, 'new');
  }
  select(0);
}

/**
 * Starts a lesson on a bench of its own, at the step after these solutions. Returns false, with `lessonFailed`, if it is not
 * valid.
 */
export async function openLesson(name: string, text: string, solutions: string[] = []): Promise<boolean> {
  state.lessonOpening.value = true;
  const { node, diagnostics } = await add({ op: 'lesson', text });
  if (node === null) {
    state.lessonOpening.value = false;
    state.lessonFailed.value = [{ name, problems: diagnostics }];
    return false;
  }
  dropFrames();
  state.tour.value = null;
  state.lessonFailed.value = [];
  state.lessonState.value = null;
  // Messages, inputs and choices from before belong to another bench.
  if (state.toast.value?.tone === 'info') state.toast.value = null;
  state.draft.value = null;
  state.selected.value = null;
  state.chosenFrame.value = null;
  for (const solution of solutions) await playScript(solution);
  state.lessonRun.value = { name, count: state.lessonRun.value.count + 1, step: solutions.length };
  state.lessonOpening.value = false;
  select(0);
  setSpeed(1);
  setRunning(true);
  state.tab.value = 'lesson';
  return true;
}

/** Plays script lines, such as the solution of a step. */
export async function playScript(text: string): Promise<void> {
  const { diagnostics } = await add({ op: 'script', text });
  if (diagnostics[0]) state.toast.value = { text: diagnostics[0].message, tone: 'error' };
}

/** Leaves the lesson; its bench stays as it is. */
export function leaveLesson(): void {
  act({ op: 'leave' });
  if (state.tab.value === 'lesson') state.tab.value = 'encoder';
  history.replaceState(null, '', location.pathname);
  setRunning(true);
}
