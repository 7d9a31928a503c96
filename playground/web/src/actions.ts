// Everything a person can do, in one place.

import type { Source } from './sim/api';
import { candumpLine, type Typed } from './can/text';
import { open, send } from './sim/link';
import { forgetWords } from './sim/words';
import * as state from './state';

export function sendFrame(frame: Typed): void {
  const data = frame.remote ? new Uint8Array(frame.dlc) : frame.data;
  send({ op: 'send', id: frame.id, data, extended: frame.extended, remote: frame.remote });
}

export const NMT_COMMANDS = [
  { code: 0x01, text: 'Start', title: 'Start remote node: Operational' },
  { code: 0x80, text: 'Pre-op', title: 'Enter Pre-operational' },
  { code: 0x02, text: 'Stop', title: 'Stop remote node: Stopped' },
  { code: 0x81, text: 'Reset node', title: 'Reset node: the device starts afresh' },
  { code: 0x82, text: 'Reset comm', title: 'Reset communication: 1000h to 1FFFh are loaded again' },
] as const;

export function nmt(code: number): void {
  send({ op: 'send', id: 0, data: new Uint8Array([code, state.nodeId.value]), extended: false, remote: false });
}

export function setPower(on: boolean): void {
  send({ op: 'power', on });
}

/** Turns the shaft to a number of revolutions; it stands still there. */
export function turnTo(turns: number): void {
  if (state.shaft.value?.rpm) setRpm(0);
  send({ op: 'turn', turns });
}

export function setRpm(rpm: number): void {
  send({ op: 'rpm', rpm });
}

export function setRunning(running: boolean): void {
  state.running.value = running;
  send({ op: 'run', running });
}

export function setSpeed(factor: number): void {
  state.speed.value = factor;
  send({ op: 'speed', factor });
}

export function step(micros: number): void {
  setRunning(false);
  send({ op: 'step', micros });
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

/** Saves the capture as a log that candump, SavvyCAN and Wireshark read. */
export function saveLog(): void {
  const { ring } = state;
  const lines: string[] = [];
  for (let number = ring.first; number < ring.end; number++) {
    const frame = ring.get(number);
    if (frame) lines.push(candumpLine(frame));
  }
  if (lines.length === 0) {
    state.toast.value = { text: 'There is no frame to save yet.', tone: 'info' };
    return;
  }
  const url = URL.createObjectURL(new Blob([`${lines.join('\n')}\n`], { type: 'text/plain' }));
  const link = document.createElement('a');
  link.href = url;
  link.download = `odkit-${state.device.value?.name ?? 'capture'}.log`;
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}

/** Puts a device on the bus; false when its file cannot be used. */
export async function openDevice(source: Source, nodeId: number): Promise<boolean> {
  const { device, diagnostics } = await open(source, nodeId);
  state.diagnostics.value = diagnostics;
  if (!device) return false;
  forgetWords();
  remember();
  return true;
}

/** Keeps device and node ID in the address, as far as a link can carry them. */
function remember(): void {
  const { value } = state.source;
  const parts = new URLSearchParams();
  if (value.kind === 'builtin') parts.set('device', value.name);
  parts.set('node', String(state.device.value?.nodeId ?? 1));
  history.replaceState(null, '', `#${parts}`);
}

/** Device and node ID of the address. */
export function recall(): { source: Source; nodeId: number } {
  const parts = new URLSearchParams(location.hash.slice(1));
  const name = parts.get('device') ?? 'gxmm';
  const node = Number(parts.get('node') ?? 1);
  return {
    source: { kind: 'builtin', name: /^[a-z0-9_]{1,16}$/.test(name) ? name : 'gxmm' },
    nodeId: Number.isInteger(node) && node >= 1 && node <= 127 ? node : 1,
  };
}
