// Serves the bundled page on 127.0.0.1: `node serve.mjs [port]`, else on 8080 or the next free port.
// Prints the address. Ends with its standard input, so that nothing outlives its starter.
import { context } from 'esbuild';
import { fileURLToPath } from 'node:url';

/** Serves a folder; port 0 is any free one. */
export async function serve(folder, port) {
  const server = await context({ logLevel: 'silent' });
  try {
    const { port: bound } = await server.serve({ servedir: fileURLToPath(folder), host: '127.0.0.1', port });
    return { url: `http://127.0.0.1:${bound}/`, stop: () => server.dispose() };
  } catch {
    await server.dispose();
    return null;
  }
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
