// Serves the bundled page on 127.0.0.1: `node serve.mjs [port]`, else on 8080 or the next free port.
// Prints the address. Ends when its standard input closes, so that it does not outlive its starter.
import { readFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import { extname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { inline, policy } from './policy.mjs';

const TYPES = {
  '.html': 'text/html; charset=utf-8',
  '.js': 'text/javascript; charset=utf-8',
  '.css': 'text/css; charset=utf-8',
  '.json': 'application/json',
  '.webmanifest': 'application/manifest+json',
  '.md': 'text/markdown; charset=utf-8',
  '.svg': 'image/svg+xml',
  '.wasm': 'application/wasm',
};

/** Serves a folder; port 0 is any free one. */
export async function serve(folder, port) {
  const root = fileURLToPath(folder);
  const server = createServer(async (request, response) => {
    const { port: own } = server.address();
    const end = (status, text) => response.writeHead(status, { 'content-type': 'text/plain' }).end(text);
    // A host name that another site has pointed to this computer is refused.
    if (![`127.0.0.1:${own}`, `localhost:${own}`].includes(request.headers.host)) return end(421, 'unknown host\n');
    if (!['GET', 'HEAD'].includes(request.method)) return end(405, 'read only\n');
    try {
      // A URL has no `..` left in it; an encoded one stays below the root.
      const path = decodeURIComponent(new URL(request.url, 'http://localhost').pathname).replace(/\/$/, '/index.html');
      const file = join(root, path);
      if (!file.startsWith(root)) return end(404, 'not found\n');
      const body = await readFile(file);
      const type = TYPES[extname(file)] ?? 'application/octet-stream';
      response.writeHead(200, {
        'content-type': type,
        'content-length': body.length,
        'cache-control': 'no-cache',
        'content-security-policy': policy(type.startsWith('text/html') ? inline(body) : ''),
        'x-content-type-options': 'nosniff',
      });
      response.end(request.method === 'HEAD' ? undefined : body);
    } catch {
      end(404, 'not found\n');
    }
  });
  const listening = new Promise((resolve) => server.once('error', () => resolve(false)).listen(port, '127.0.0.1', () => resolve(true)));
  if (!(await listening)) return null;
  const stop = () => {
    server.close();
    server.closeAllConnections();
  };
  return { url: `http://127.0.0.1:${server.address().port}/`, stop };
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
  const given = process.argv[2];
  let port = Number(given ?? 8080);
  let server = await serve(new URL('dist/', import.meta.url), port);
  while (!server && given === undefined && port < 8180) server = await serve(new URL('dist/', import.meta.url), ++port);
  if (server) {
    console.log(server.url);
    process.stdin.on('end', () => process.exit()).resume();
  } else {
    console.error(`port ${port} of 127.0.0.1 is in use`);
    process.exitCode = 1;
  }
}
