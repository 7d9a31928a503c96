// The tests run in two processes, each with one browser and few pages: a test mostly waits for its page.
import { readdir, stat } from 'node:fs/promises';

/** Loads every second test file, the largest first; `which` is 0 or 1. */
export async function half(which) {
  const here = (name) => new URL(name, import.meta.url);
  const names = (await readdir(here('.'))).filter((name) => name.endsWith('.test.mjs'));
  const files = await Promise.all(names.map(async (name) => ({ name, size: (await stat(here(name))).size })));
  files.sort((a, b) => b.size - a.size || (a.name < b.name ? -1 : 1));
  for (const { name } of files.filter((_, at) => at % 2 === which)) await import(here(name));
}
