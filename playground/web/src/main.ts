import { begin, recall } from './actions';
import type { Connect } from './real/dialog';
import { start } from './sim/link';
import * as state from './state';
import { T } from './texts';
import './views/app';

start();
void open().then(settle);
window.addEventListener('hashchange', () => {
  state.deviceDialog.value = null;
  void open();
});

/** Opens the bench or the lesson in the address, or a new bench with its devices. */
async function open(): Promise<void> {
  const { hash } = location;
  if (hash.startsWith('#bench=')) {
    const { openHash } = await import('./share/make');
    if (await openHash(hash)) return;
  }
  if (hash.startsWith('#bus=')) {
    const bus = plain(hash.slice(5));
    history.replaceState(null, '', location.pathname + location.search);
    if (state.devices.value.length === 0) await begin(recall());
    await import('./real/dialog');
    return document.querySelector<Connect>('od-connect')!.go(bus);
  }
  const asked = new URLSearchParams(hash.slice(1));
  const fault = asked.get('case');
  if (fault || asked.has('test')) {
    state.finalTest.value = !fault;
    if (fault) state.faultCase.value = { name: fault, seed: Number(asked.get('seed')) >>> 0 };
    state.lessonDialog.value = true;
    if (state.devices.value.length > 0) return;
  }
  const lesson = asked.get('lesson') ?? (hash.length > 1 ? null : new URLSearchParams(location.search).get('lesson'));
  if (lesson) {
    const { resume } = await import('./share/keep');
    if (state.devices.value.length === 0 && (await resume(lesson).catch(() => false))) return;
    const { openNamed } = await import('./lessons/open');
    let isThere = false;
    const meanwhile = async (): Promise<void> => {
      if (state.real.value) return;
      isThere = true;
      state.toast.value = { text: T.lessons.slow(lesson), tone: 'info' };
      return begin(recall());
    };
    if ((await openNamed(lesson, meanwhile)) || isThere) return;
  }
  // A connected real bus stays connected.
  if (!state.real.value) await begin(recall());
  const lab = asked.get('lab');
  if (lab && !state.real.value) await (await import('./labs/open')).openLab(lab);
}

/** Decodes an address; one with an invalid encoding is used as it is. */
function plain(text: string): string {
  try {
    return decodeURIComponent(text);
  } catch {
    return text;
  }
}

/** Tasks that can wait until the bench runs. A frame in another page stores nothing. */
async function settle(): Promise<void> {
  const { start: record } = await import('./seeing/tracks');
  record();
  if ('embed' in document.documentElement.dataset) return;
  const { start: keep } = await import('./share/keep');
  await keep();
  // A class serves the page: it reports there, and is not for later without it.
  if ('class' in document.documentElement.dataset) return (await import('./class/session')).start();
  const { register } = await import('./share/offline');
  await register();
}
