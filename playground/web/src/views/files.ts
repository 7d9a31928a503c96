// A file from the user's disk.

import { use } from '../sim/link';
import * as state from '../state';
import { T } from '../texts';

/** Recognises a bus log by its name. */
const LOG = /\.(log|asc|blf|trc|pcap|pcapng|candump|dump)$/i;
/** Name of a text of any kind. */
const TEXT = /\.(txt|csv|out|text)$|^[^.]+$/i;
const LONGEST_LOG = 100_000_000;

/** Maximum size of a file: the largest known EDS files have about 2 MB. */
const LONGEST = 8_000_000;

/** Opens a log of another tool; asks before it replaces a capture. */
async function openLog(name: string, bytes: Uint8Array): Promise<void> {
  const [read, { opened }] = await Promise.all([use('readLog', bytes), import('../seeing/log')]);
  if ('error' in read) state.toast.value = { text: T.frames.unreadable(name, read.error), tone: 'error' };
  else opened(name, read.value);
}

/** The file with a name that can be shown: without characters that control the text around it. */
function plain(file: File): File {
  const name = file.name.replaceAll(/\p{C}/gu, '\ufffd');
  return name === file.name ? file : new File([file], name, { type: file.type });
}

export async function openFile(given: File, nodeId: number, place: number | 'new'): Promise<boolean> {
  const file = plain(given);
  if (LOG.test(file.name) && file.size < LONGEST_LOG) {
    await openLog(file.name, new Uint8Array(await file.arrayBuffer()));
    return true;
  }
  if (/\.dbc$/i.test(file.name) && file.size < LONGEST) {
    const { opened } = await import('../seeing/dbc');
    return opened(file.name, new Uint8Array(await file.arrayBuffer()));
  }
  // A log may have any name: the readers of logs decide.
  if (TEXT.test(file.name) && file.size < LONGEST_LOG) {
    const bytes = new Uint8Array(await file.arrayBuffer());
    const [read, { opened }] = await Promise.all([use('readLog', bytes), import('../seeing/log')]);
    if ('value' in read && read.value.count > 0) {
      opened(file.name, read.value);
      return true;
    }
  }
  if (file.size > LONGEST) {
    state.toast.value = { text: T.files.tooLarge(file.name), tone: 'error' };
    return false;
  }
  if (/\.(md|markdown)$/i.test(file.name)) {
    const { openFile: openLesson } = await import('../lessons/open');
    return openLesson(file);
  }
  if (/\.json$/i.test(file.name)) {
    const share = await import('../share/make');
    return share.openText(await file.text(), file.name);
  }
  const { openBytes } = await import('../editor/open');
  return openBytes(file.name, new Uint8Array(await file.arrayBuffer()), nodeId, place);
}
