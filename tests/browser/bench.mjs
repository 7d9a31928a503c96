// What the tests do over and over, in the words of a person at the page.
import assert from 'node:assert/strict';

/** Waits until `probe` answers with something true; says what was expected if it never does. */
export async function until(what, probe, { within = 6000 } = {}) {
  const end = Date.now() + within;
  for (;;) {
    const value = await probe();
    if (value) return value;
    if (Date.now() > end) assert.fail(`expected ${what}`);
    await new Promise((resolve) => setTimeout(resolve, 40));
  }
}

/** The rows on screen, oldest first. */
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

/** Waits for a row; answers with it. */
export const row = (page, what, test) => until(`a row in the console: ${what}`, async () => (await rows(page)).find(test));

export const booted = (page) => row(page, 'the boot-up of node 1', (one) => one.id === '701' && one.data === '00');

export async function sendRaw(page, text) {
  const line = page.getByRole('textbox', { name: 'Frame', exact: true });
  await line.fill(text);
  await line.press('Enter');
}

export const nmt = (page, name) => page.getByRole('button', { name: `NMT ${name}`, exact: true }).click();

export const state = (page) => page.getByLabel('NMT state').textContent();

/** The number in a readout, without its thin spaces. */
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
