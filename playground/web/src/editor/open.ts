// Opens a file that may be an EDS: puts it on the bus, and reports its findings.

import { openDevice } from '../actions';
import { opened } from '../seeing/log';
import * as state from '../state';
import { E } from './texts';
import { kindOf } from './kind';

/** Opens the bytes of a file; false if it is not on the bus. */
export async function openBytes(name: string, bytes: Uint8Array, nodeId: number, place: number | 'new'): Promise<boolean> {
  const kind = await kindOf(bytes);
  if (typeof kind !== 'string') {
    const { what, next, log, isEmpty } = kind;
    const write = (): void => void (state.editing.value = { name, text: '', nodeId, place, at: null });
    const action = log ? { text: E.report.asLog, run: () => opened(name, log) } : isEmpty ? { text: E.report.edit, run: write } : undefined;
    report({ name, said: E.report.not(name, what, next), isBad: true, device: null, ...(action && { action }) });
    return false;
  }
  return openText({ name, text: kind, bytes, nodeId, place }, false);
}

/** Runs an EDS text; a lenient attempt leaves out its errors. */
export async function openText(device: state.OpenedDevice, lenient: boolean): Promise<boolean> {
  const { name, text, nodeId, place } = device;
  const { node, why } = await openDevice({ kind: 'eds', name, text, lenient }, nodeId, place, false);
  const isOpen = node !== null;
  const said = isOpen ? (lenient ? E.report.lenient : E.report.runs)(name, nodeId) : why ? E.report.full(name, why) : E.report.cannot(name);
  report({ name, said, isBad: !isOpen, device: { ...device, place: node ?? place } });
  return isOpen;
}

function report(about: state.Opened): void {
  state.deviceDialog.value = null;
  // Its text is open behind the report.
  state.editing.value = null;
  state.report.value = about;
}
