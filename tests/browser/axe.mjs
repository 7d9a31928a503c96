// Runs axe in the page: https://github.com/dequelabs/axe-core.
import { readFile } from 'node:fs/promises';
import { createRequire } from 'node:module';
import { becomes } from './bench.mjs';

const axe = await readFile(createRequire(import.meta.url).resolve('axe-core/axe.min.js'), 'utf8');

async function faults(page, part) {
  // The policy of the page allows only its own scripts.
  if (!(await page.evaluate(() => 'axe' in globalThis))) await page.evaluate(axe);
  // Only violations need an address. A rule about sound and an experimental rule need preloaded files; no other rule does.
  const { violations } = await page.evaluate((part) => globalThis.axe.run(part, { resultTypes: ['violations'], preload: false }), part);
  return violations.map((one) => `${one.id}: ${one.nodes.map((node) => node.target).join(', ')}`);
}

/** The findings of axe in the page, or in a part of it if the rest was checked before. */
export const flawless = (page, where, part = 'html') => becomes(`what axe finds: ${where}`, () => faults(page, part), []);
