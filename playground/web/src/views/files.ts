// An EDS file from the user's disk to the bus.

import { openDevice } from '../actions';
import * as state from '../state';

/** Longest file that is worth a try: the largest known EDS files have about 2 MB. */
const LONGEST = 8_000_000;

export async function openFile(file: File, nodeId: number): Promise<boolean> {
  state.attempt.value = null;
  if (file.size > LONGEST) {
    state.toast.value = { text: `${file.name} is too large for an EDS file.`, tone: 'error' };
    return false;
  }
  const text = decodeText(new Uint8Array(await file.arrayBuffer()));
  const isOpen = await openDevice({ kind: 'eds', name: file.name, text }, nodeId);
  const found = state.diagnostics.value;
  if (isOpen) {
    const warnings = found.filter((one) => one.severity !== 'info').length;
    state.toast.value = {
      text: `${file.name} is on the bus${warnings ? `, with ${warnings} warning${warnings > 1 ? 's' : ''}` : ''}.`,
      tone: 'info',
    };
    state.deviceDialog.value = false;
  } else {
    state.attempt.value = { name: file.name, text, diagnostics: found };
    state.deviceDialog.value = true;
  }
  return isOpen;
}

/** EDS files come as UTF-8 or Windows-1252. */
function decodeText(bytes: Uint8Array): string {
  try {
    return new TextDecoder('utf-8', { fatal: true }).decode(bytes);
  } catch {
    return new TextDecoder('windows-1252').decode(bytes);
  }
}
