// The service worker. The build puts the list of files in, each with the hash of its
// content: a new version fetches what changed and takes the rest from the old one.
const FILES = new Map(/* FILES */);
const CACHE = 'odkit';

const scope = new URL('./', self.location.href);
const keyOf = (name) => new URL(`${name}?${FILES.get(name)}`, scope).href;

self.addEventListener('install', (event) => {
  const fill = async () => {
    const cache = await caches.open(CACHE);
    const get = async (name) => {
      if (await cache.match(keyOf(name))) return;
      const response = await fetch(new URL(name, scope), { cache: 'no-cache' });
      if (!response.ok) throw new Error(`${name}: ${response.status}`);
      await cache.put(keyOf(name), response);
    };
    await Promise.all([...FILES.keys()].map(get));
  };
  event.waitUntil(fill());
});

self.addEventListener('activate', (event) => {
  const tidy = async () => {
    const cache = await caches.open(CACHE);
    const wanted = new Set([...FILES.keys()].map(keyOf));
    const old = (await cache.keys()).filter(({ url }) => !wanted.has(url));
    await Promise.all(old.map((request) => cache.delete(request)));
    await self.clients.claim();
  };
  event.waitUntil(tidy());
});

self.addEventListener('message', ({ data }) => {
  if (data === 'take over') void self.skipWaiting();
});

self.addEventListener('fetch', (event) => {
  const { request } = event;
  const url = new URL(request.url);
  if (request.method !== 'GET' || !url.href.startsWith(scope.href)) return;
  const name = url.pathname.slice(scope.pathname.length) || 'index.html';
  if (!FILES.has(name)) return;
  const answer = async () => (await (await caches.open(CACHE)).match(keyOf(name))) ?? fetch(request);
  event.respondWith(answer());
});
