// The page without a network: a service worker keeps its files, and reports new ones.

import * as state from '../state';
import { D } from '../views/texts';
import { trusted } from '../trusted';

declare const OFFLINE: boolean;

export async function register(): Promise<void> {
  // During development old files would be confusing.
  if (!OFFLINE || !('serviceWorker' in navigator)) return;
  const { serviceWorker } = navigator;
  let registration: ServiceWorkerRegistration;
  try {
    registration = await serviceWorker.register(trusted('sw.js'));
  } catch {
    // Private windows and file: addresses have no service worker.
    return;
  }
  const watch = (worker: ServiceWorker | null): void => {
    const tell = (): void => {
      // The first installation replaces nothing.
      if (worker?.state === 'installed' && serviceWorker.controller) offer(worker);
    };
    worker?.addEventListener('statechange', tell);
    tell();
  };
  watch(registration.waiting ?? registration.installing);
  registration.addEventListener('updatefound', () => watch(registration.installing));
  document.addEventListener('visibilitychange', () => {
    if (document.visibilityState === 'visible') void registration.update().catch(() => undefined);
  });
}

function offer(worker: ServiceWorker): void {
  const run = (): void => {
    navigator.serviceWorker.addEventListener('controllerchange', () => location.reload(), { once: true });
    worker.postMessage('take over');
  };
  const others = state.offers.value.filter((one) => one.key !== 'update');
  state.offers.value = [...others, { key: 'update', text: D.share.update, action: D.share.reload, run }];
}
