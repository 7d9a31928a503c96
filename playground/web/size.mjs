// What the first visit downloads, gzipped, against the budget.
import { readdir, readFile } from 'node:fs/promises';
import { gzipSync } from 'node:zlib';

const BUDGET = 250;
const dist = new URL('dist/', import.meta.url);
let total = 0;
for (const name of (await readdir(dist)).sort()) {
  const bytes = await readFile(new URL(name, dist));
  const kilobytes = gzipSync(bytes, { level: 9 }).length / 1000;
  total += kilobytes;
  console.log(`${name.padEnd(26)} ${(bytes.length / 1000).toFixed(1).padStart(8)} kB ${kilobytes.toFixed(1).padStart(8)} kB gzip`);
}
console.log(`${'first load'.padEnd(26)} ${''.padStart(11)} ${total.toFixed(1).padStart(8)} kB gzip (budget ${BUDGET})`);
if (total > BUDGET) process.exitCode = 1;
