// Accessibility: axe finds no fault, keys reach every control, also in the dark theme.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { flawless } from './axe.mjs';
import { becomes, booted, nmt, row } from './bench.mjs';
import { open } from './check.mjs';

for (const colorScheme of ['light', 'dark']) {
  test(`axe finds nothing, ${colorScheme}`, async () => {
    const { page, close } = await open({ colorScheme });
    await booted(page);
    await nmt(page, 'Start');
    await row(page, 'a PDO1', (one) => one.id === '181');
    await flawless(page, 'the page');
    await page.locator('.device-button').click();
    await page.getByRole('dialog', { name: 'Device on the bus' }).waitFor();
    await flawless(page, 'the devices', 'dialog[open]');
    await close();
  });
}

test('axe finds nothing on a phone', async () => {
  const { page, close } = await open({ width: 390, height: 844 });
  for (const name of ['Bus', 'Objects', 'Encoder']) {
    await page.getByRole('tab', { name }).click();
    await flawless(page, name);
  }
  await close();
});

test('the sheet of keys opens by its key', async () => {
  const { page, close } = await open();
  await booted(page);
  await page.keyboard.press('?');
  const sheet = page.getByRole('dialog', { name: 'Keys' });
  await sheet.waitFor();
  await flawless(page, 'the keys', 'dialog[open]');
  await page.keyboard.press('Escape');
  await sheet.waitFor({ state: 'hidden' });
  await close();
});

test('axe finds nothing in dialogs', async () => {
  for (const [width, height] of [[1280, 800], [390, 844]]) {
    const { page, close } = await open({ width, height, hash: '#device=eam_mt&node=1' });
    await page.getByRole('button', { name: 'Share and save' }).click();
    await page.getByRole('dialog', { name: 'Share and save' }).waitFor();
    await flawless(page, `sharing, ${width}`, 'dialog[open]');
    await page.keyboard.press('Escape');
    if (width < 1024) await page.getByRole('tab', { name: 'Objects' }).click();
    await page.getByRole('searchbox', { name: 'Search objects' }).fill('6001');
    await page.getByRole('listbox', { name: 'Objects with their live values' }).getByRole('option').filter({ hasText: '6001h' }).click();
    await page.locator('od-object-detail').getByText('6001h').first().waitFor();
    await flawless(page, `an object, ${width}`, width < 1024 ? 'od-objects' : 'html');
    await page.getByRole('button', { name: 'PDO mapping' }).click();
    const dialog = page.getByRole('dialog', { name: 'PDO mapping' });
    await dialog.locator('.mapping-steps li').first().waitFor();
    await dialog.getByRole('button', { name: /^Send/ }).click();
    await dialog.getByText('✓').first().waitFor();
    await flawless(page, `the mapping, ${width}`, 'dialog[open]');
    await close();
  }
});

test('axe finds nothing in figures, plots, the trigger and a log', async () => {
  for (const [width, height, colorScheme] of [[1280, 800, 'dark'], [390, 844, 'light']]) {
    const { page, close } = await open({ width, height, colorScheme });
    if (width < 1024) await page.getByRole('tab', { name: 'Bus' }).click();
    await booted(page);
    await page.getByRole('button', { name: 'By CAN-ID' }).click();
    await page.locator('.ids tbody').first().waitFor();
    await flawless(page, `figures, ${width}`, 'od-console');
    await page.getByRole('button', { name: 'Plot', exact: true }).click();
    await page.getByRole('button', { name: 'Trigger', exact: true }).click();
    await page.getByRole('textbox', { name: 'Stop the capture at' }).waitFor();
    await page.getByRole('spinbutton', { name: 'Cursor A in seconds' }).fill('0.5');
    await page.keyboard.press('Tab');
    await page.getByRole('table', { name: 'Cursors' }).waitFor();
    await flawless(page, `a plot and the trigger, ${width}`, 'od-console');
    const transfer = await page.evaluateHandle(() => {
      const data = new DataTransfer();
      data.items.add(new File(['(1.0) can0 181#01'], 'one.log'));
      return data;
    });
    await page.dispatchEvent('body', 'drop', { dataTransfer: transfer });
    await page.getByRole('button', { name: 'Open beside it' }).waitFor();
    await flawless(page, `what becomes of a log, ${width}`, 'od-offers');
    await page.getByRole('button', { name: 'Open beside it' }).click();
    await page.getByRole('group', { name: 'Log one.log' }).waitFor();
    await flawless(page, `a log, ${width}`);
    await close();
  }
});

test('keys alone: from part to part, to the filter, to an object and its value', async () => {
  const { page, close } = await open();
  await booted(page);
  const focused = () => page.evaluate(() => document.activeElement.getAttribute('aria-label') ?? document.activeElement.id);
  const after = async (key, name) => {
    await page.keyboard.press(key);
    await becomes(`the focus after ${key}`, focused, name);
  };
  for (const name of ['Shaft', 'Objects with their live values', 'Captured frames, oldest first', 'raw-frame']) await after('F6', name);
  await page.keyboard.press('F6');
  await after('F6', 'Shaft');
  await after('/', 'Filter frames');
  await page.getByRole('searchbox', { name: 'Search objects' }).fill('6001');
  await page.getByRole('listbox', { name: 'Objects with their live values' }).focus();
  await page.keyboard.press('ArrowDown');
  await after('Enter', 'New value');
  await page.keyboard.type('1000');
  await page.keyboard.press('Enter');
  await row(page, 'the download', (one) => one.id === '601' && one.data.startsWith('23 01 60 00 E8 03'));
  await close();
});

test('the keyboard reaches every control, in a sensible order', async () => {
  const { page, close } = await open();
  await booted(page);
  const names = [];
  for (let i = 0; i < 80; i++) {
    await page.keyboard.press('Tab');
    const name = await page.evaluate(() => {
      const { activeElement: it } = document;
      if (!it || it === document.body) return null;
      const ring = getComputedStyle(it);
      return { name: it.getAttribute('aria-label') ?? it.labels?.[0]?.textContent ?? it.textContent.trim(), ring: ring.outlineStyle !== 'none' };
    });
    if (name === null) break;
    assert.ok(name.ring, `${name.name} shows its focus`);
    names.push(name.name);
  }
  const order = ['Pause time', 'Power', 'Shaft', 'Search objects', 'Frame', 'Object', 'Read', 'Write', 'NMT Start'].map((name) => names.indexOf(name));
  assert.ok(order.every((place) => place >= 0), `all in ${names}`);
  assert.deepEqual([...order].sort((a, b) => a - b), order);
  await close();
});
