import { begin, recall } from './actions';
import { start } from './sim/link';
import { deviceDialog } from './state';
import './views/app';

start();
void open().then(settle);
window.addEventListener('hashchange', () => {
  deviceDialog.value = null;
  void open();
});

/** The bench that the address holds, or a fresh one with its devices. */
async function open(): Promise<void> {
  const { hash } = location;
  if (hash.startsWith('#bench=')) {
    const { openHash } = await import('./share/make');
    if (await openHash(hash)) return;
  }
  await begin(recall());
}

/** What can wait until the bench runs. A frame in another page keeps nothing. */
async function settle(): Promise<void> {
  if ('embed' in document.documentElement.dataset) return;
  const { start: keep } = await import('./share/keep');
  await keep();
  const { register } = await import('./share/offline');
  await register();
}
