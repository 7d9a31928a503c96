// The service worker. The build puts the list of files in, each with the hash of its
// content: a new version fetches what changed and takes the rest from the old one. What does not
// have its hash is not kept, so versions never mix.
const FILES = new Map(/* FILES */);
const CACHE = 'odkit';

/** Is it the file that this version was built with? */
const holds = async (name, response) => {
  const digest = new Uint8Array(await crypto.subtle.digest('SHA-256', await response.clone().arrayBuffer()));
  const text = btoa(String.fromCharCode(...digest)).replaceAll('+', '-').replaceAll('/', '_');
  return text.startsWith(FILES.get(name));
};

const scope = new URL('./', self.location.href);
const keyOf = (name) => new URL(`${name}?${FILES.get(name)}`, scope).href;

self.addEventListener('install', (event) => {
  const fill = async () => {
    const cache = await caches.open(CACHE);
    const get = async (name) => {
      const kept = await cache.match(keyOf(name));
      if (kept && (await holds(name, kept))) return;
      for (const mode of ['no-cache', 'reload']) {
        const response = await fetch(new URL(name, scope), { cache: mode });
        if (!response.ok) throw new Error(`${name}: ${response.status}`);
        if (await holds(name, response)) return cache.put(keyOf(name), response);
      }
      // A deployment under way: this version is not taken, and the next visit tries again.
      throw new Error(`${name} is of another version`);
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
