// Compares the gzipped size of the first visit with its budget, and prints the parts that are loaded later.
import { readdir, readFile } from 'node:fs/promises';
import { gzipSync } from 'node:zlib';

// The bound of docs/PERFORMANCE.md.
const BUDGET = 250;
const dist = new URL('dist/', import.meta.url);
const read = (name) => readFile(new URL(name, dist));

// Scripts include their static imports, not their dynamic ones.
const first = new Set(['index.html', 'icon.svg', 'style.css', 'core.wasm']);
const scripts = ['main.js', 'worker.js'];
while (scripts.length) {
  const name = scripts.pop();
  if (first.has(name)) continue;
  first.add(name);
  const text = await read(name).then(String);
  for (const [, part] of text.matchAll(/(?:^|[;}\n])(?:import|export)(?:[^;("']*from)?\s*"\.\/([^"]+\.js)"/g)) scripts.push(part);
}

let total = 0;
const row = (name, bytes, kilobytes) =>
  console.log(`${name.padEnd(26)} ${(bytes / 1000).toFixed(1).padStart(8)} kB ${kilobytes.toFixed(1).padStart(8)} kB gzip`);
const later = [];
for (const name of (await readdir(dist)).sort()) {
  const bytes = await read(name);
  const kilobytes = gzipSync(bytes, { level: 9 }).length / 1000;
  if (!first.has(name)) {
    later.push([name, bytes.length, kilobytes]);
    continue;
  }
  total += kilobytes;
  row(name, bytes.length, kilobytes);
}
console.log(`${'first load'.padEnd(26)} ${''.padStart(11)} ${total.toFixed(1).padStart(8)} kB gzip (budget ${BUDGET})`);
if (later.length) console.log('when asked for:');
for (const one of later) row(...one);
if (total > BUDGET) process.exitCode = 1;
