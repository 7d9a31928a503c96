// Shows an opened log in the console: beside the capture, or in its place.

import { clearConsole, saveLog, setRunning } from '../actions';
import { revealed } from '../capture';
import type { Log } from '../sim/api';
import * as state from '../state';
import { Ring } from '../trace/ring';
import { forget, start } from './player';
import { beside as besideLog, close, putBeside, showLive } from './shelf';
import './shelf-tabs';
import { S } from './texts';

/** End of the ring when a log replaced the capture; null: the ring has a capture. The next frame makes it one again. */
let onlyLog: { cleared: number; end: number } | null = null;

/** Whether the frames that are shown are those of a log only. */
export function isLog(): boolean {
  void state.captured.value;
  const isAlone = onlyLog !== null && onlyLog.end === state.ring.end && onlyLog.cleared === state.cleared.value;
  return isAlone || (besideLog.value?.isShown ?? false);
}

/** The frames of one bus in a log, and the lines that could not be read. */
type BusLog = Omit<Log, 'channels'> & { frames: Uint8Array };

/** Shows a log. The user is asked which bus, if it has several, and before a capture is replaced. */
export function opened(name: string, log: Log): void {
  const buses = log.channels.map((bus) => ({ text: S.log.bus(bus.name, bus.count), run: () => openedBus(bus.name ? `${name}, ${bus.name}` : name, { ...log, ...bus }) }));
  const [first, ...others] = buses;
  if (!first || others.length === 0) return first?.run();
  state.offers.value = [...state.offers.value.filter(({ key }) => key !== 'log'), { key: 'log', text: S.log.which(name, buses.length), action: first.text, run: first.run, others }];
}

function openedBus(name: string, log: BusLog): void {
  const { ring } = state.live;
  const isFree = ring.end === ring.first || (onlyLog?.end === ring.end && onlyLog.cleared === state.cleared.value);
  state.offers.value = state.offers.value.filter(({ key }) => key !== 'log');
  if (isFree) return replace(name, log);
  const text = S.log.ask(name, log.count, ring.end - ring.first) + skipped(log);
  const save = async (): Promise<void> => {
    showLive();
    await saveLog('log');
    replace(name, log);
  };
  const others = [
    { text: S.log.save, run: () => void save() },
    { text: S.log.replace, run: () => replace(name, log) },
  ];
  state.offers.value = [...state.offers.value, { key: 'log', text, action: S.log.beside, run: () => beside(name, log), others }];
}

const skipped = (log: BusLog): string => (log.skipped ? ` ${S.log.skipped(log.skipped, log.line, log.why)}` : '');

function tell(name: string, log: BusLog, isBeside: boolean): void {
  forget();
  // A log is read from its beginning.
  revealed.value = { number: state.ring.first };
  state.log.value = { name, frames: log.frames, count: log.count };
  const text = S.log.opened(name, log.count, isBeside) + skipped(log);
  state.toast.value = { text, tone: log.skipped ? 'error' : 'info', action: { text: S.log.send, run: () => start('bus') } };
}

function beside(name: string, log: BusLog): void {
  const ring = new Ring();
  ring.append(log.frames);
  putBeside(name, ring);
  tell(name, log, true);
}

/** Pauses time, so that no frames mix with the log; a real bus cannot be paused. */
function replace(name: string, log: BusLog): void {
  close();
  clearConsole();
  if (state.real.value) return beside(name, log);
  setRunning(false);
  state.ring.append(log.frames);
  state.captured.value = state.ring.end;
  onlyLog = { cleared: state.cleared.value, end: state.ring.end };
  tell(name, log, false);
}
