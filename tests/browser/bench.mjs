// Common steps of the tests, named as a user would name them.
import assert from 'node:assert/strict';
import { inspect, isDeepStrictEqual } from 'node:util';
import { opened } from './harness.mjs';

/** Milliseconds that a busy machine may need. */
const PATIENCE = 60_000;

/** The errors and the content of the open pages, for a failing test. */
async function seen() {
  const looks = [...opened].map(async ([page, faults]) => {
    const looked = page.evaluate(() => `${document.visibilityState}: ${document.body.innerText.replaceAll(/\s+/g, ' ').slice(0, 3000)}`).catch(String);
    const stuck = new Promise((resolve) => setTimeout(resolve, 5000, 'the page does not answer'));
    return ['', page.url(), ...faults, await Promise.race([looked, stuck])].join('\n  ');
  });
  return (await Promise.all(looks)).join('');
}

/** Waits until `holds` accepts the result of `probe`, and returns it; `fail` gets the last result and the content of the pages. */
async function poll(probe, holds, fail) {
  const end = Date.now() + PATIENCE;
  for (;;) {
    const value = await probe();
    if (holds(value)) return value;
    if (Date.now() > end) fail(value, await seen());
    await new Promise((resolve) => setTimeout(resolve, 40));
  }
}

/** Waits until `probe` returns a true value; otherwise fails with the expectation. */
export const until = (what, probe) => poll(probe, Boolean, (_, there) => assert.fail(`expected ${what}${there}`));

/** Waits until `probe` returns `expected`, or a text that matches this pattern. */
export function becomes(what, probe, expected) {
  if (expected instanceof RegExp) return poll(probe, (value) => expected.test(value), (value, there) => assert.match(value, expected, `${what}: ${value}${there}`));
  return poll(probe, (value) => isDeepStrictEqual(value, expected), (value, there) => assert.deepEqual(value, expected, `${what}: ${inspect(value)}${there}`));
}

/** Waits until `probe` returns the same value for this time of the bench in milliseconds; returns it. */
export async function stays(page, what, probe, milliseconds) {
  let since = await clock(page);
  let value = await probe();
  return poll(
    async () => {
      const now = await clock(page);
      const fresh = await probe();
      if (!isDeepStrictEqual(fresh, value)) [since, value] = [now, fresh];
      return now - since >= milliseconds ? { value } : null;
    },
    Boolean,
    (_, there) => assert.fail(`expected ${what} to stay; it is ${value}${there}`),
  ).then((found) => found.value);
}

/** A file for an input of the page, from memory: no test leaves one on the disk. */
export const file = (name, text) => ({ name, mimeType: 'text/plain', buffer: Buffer.from(text) });

/** Virtual time in milliseconds. */
export async function clock(page) {
  const text = await page.getByRole('timer').textContent();
  return Math.round(text.split(':').reduce((sum, part) => sum * 60 + Number(part), 0) * 1000);
}

/** Waits until this much virtual time has passed, in milliseconds. */
export async function pass(page, milliseconds) {
  const from = await clock(page);
  await until(`${milliseconds} ms to pass`, async () => (await clock(page)) - from >= milliseconds);
}

/** Pauses time. Snapshots in transit still arrive, so time counts as paused when the clock has not changed for half a second. */
export async function stopTime(page) {
  await page.getByRole('button', { name: 'Pause time' }).click();
  let [at, since] = [-1, 0];
  await until('time to stop', async () => {
    const now = await clock(page);
    if (now !== at) [at, since] = [now, Date.now()];
    return Date.now() - since >= 500;
  });
  await page.getByRole('button', { name: 'Run time' }).waitFor();
}

/** The rows on screen whose CAN-ID this is. Its digits may also be in a time or in data. */
export const framesOf = (page, id) => page.locator('.frame').filter({ has: page.locator('.id', { hasText: new RegExp(`^\\s*${id}\\s*$`) }) });

/** The visible rows, oldest first. */
export const rows = (page) =>
  page.$$eval('.frame:not([hidden])', (elements) =>
    elements
      .map((row) => {
        const cell = (name) => row.querySelector(`.${name}`)?.textContent ?? '';
        return {
          number: Number(row.dataset.number),
          time: Number(cell('time')),
          dir: cell('dir'),
          id: cell('id'),
          tag: cell('tag'),
          data: cell('data'),
          words: cell('words'),
        };
      })
      .sort((a, b) => a.number - b.number),
  );

/** Waits for a row, and returns it. */
export const row = (page, what, test) => until(`a row in the console: ${what}`, async () => (await rows(page)).find(test));

export const booted = (page) => row(page, 'the boot-up of node 1', (one) => one.id === '701' && one.data === '00');

export async function sendRaw(page, text) {
  const line = page.getByRole('textbox', { name: 'Frame', exact: true });
  await line.fill(text);
  await line.press('Enter');
}

export const nmt = (page, name) => page.getByRole('button', { name: `NMT ${name}`, exact: true }).click();

export const state = (page) => page.getByLabel('NMT state').textContent();

/** The number in a display, without its thin spaces. */
export async function number(page, label) {
  const text = await page.getByLabel(label, { exact: true }).textContent();
  return Number(text.replace(/[\s\u2007\u2009°]/g, ''));
}

export const position = (page) => number(page, 'Position value 6004h');

export async function sdo(page, object, value) {
  const box = page.getByRole('combobox', { name: 'Object', exact: true });
  await box.fill(object);
  await box.press('Escape');
  const field = page.getByRole('textbox', { name: 'Value', exact: true });
  await field.fill(value ?? '');
  await page.getByRole('button', { name: value === undefined ? 'Read' : 'Write', exact: true }).click();
}

export const sdoNote = (page) => page.locator('#sdo-note').textContent();

export const captured = (page) => number(page, 'Captured frames');
