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

/** Shows a log. The user is asked before a capture is replaced. */
export function opened(name: string, log: Log): void {
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

const skipped = (log: Log): string => (log.skipped ? ` ${S.log.skipped(log.skipped, log.line, log.why)}` : '');

function tell(name: string, log: Log, isBeside: boolean): void {
  forget();
  // A log is read from its beginning.
  revealed.value = { number: state.ring.first };
  state.log.value = { name, frames: log.frames, count: log.count };
  const text = S.log.opened(name, log.count, isBeside) + skipped(log);
  state.toast.value = { text, tone: log.skipped ? 'error' : 'info', action: { text: S.log.send, run: () => start('bus') } };
}

function beside(name: string, log: Log): void {
  const ring = new Ring();
  ring.append(log.frames);
  putBeside(name, ring);
  tell(name, log, true);
}

/** Pauses time, so that no frames mix with the log; a real bus cannot be paused. */
function replace(name: string, log: Log): void {
  close();
  clearConsole();
  if (state.real.value) return beside(name, log);
  setRunning(false);
  state.ring.append(log.frames);
  state.captured.value = state.ring.end;
  onlyLog = { cleared: state.cleared.value, end: state.ring.end };
  tell(name, log, false);
}
