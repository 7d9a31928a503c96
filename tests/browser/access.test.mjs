// People who use no mouse, no eyes, or little light: axe finds nothing, keys reach everything.
import assert from 'node:assert/strict';
import { createRequire } from 'node:module';
import { after, before, test } from 'node:test';
import { launch, open } from './harness.mjs';
import { booted, nmt, row } from './bench.mjs';

const axe = createRequire(import.meta.url).resolve('axe-core/axe.min.js');

let browser;
before(async () => (browser = await launch()));
after(() => browser?.close());

async function faults(page) {
  await page.addScriptTag({ path: axe });
  const { violations } = await page.evaluate(() => globalThis.axe.run());
  return violations.map((one) => `${one.id}: ${one.nodes.map((node) => node.target).join(', ')}`);
}

for (const colorScheme of ['light', 'dark']) {
  test(`axe finds nothing, ${colorScheme}`, async () => {
    const { page, close } = await open(browser, { colorScheme });
    await booted(page);
    await nmt(page, 'Start');
    await row(page, 'a PDO1', (one) => one.id === '181');
    assert.deepEqual(await faults(page), []);
    await page.locator('.device-button').click();
    assert.deepEqual(await faults(page), []);
    await close();
  });
}

test('axe finds nothing on a phone', async () => {
  const { page, close } = await open(browser, { width: 390, height: 844 });
  for (const name of ['Bus', 'Objects', 'Encoder']) {
    await page.getByRole('tab', { name }).click();
    assert.deepEqual(await faults(page), [], name);
  }
  await close();
});

test('the sheet of keys opens by its key', async () => {
  const { page, close } = await open(browser, {});
  await booted(page);
  await page.keyboard.press('?');
  const sheet = page.getByRole('dialog', { name: 'Keys' });
  assert.ok(await sheet.isVisible());
  assert.deepEqual(await faults(page), []);
  await page.keyboard.press('Escape');
  assert.ok(!(await sheet.isVisible()));
  await close();
});

test('axe finds nothing in what opens over the page', async () => {
  for (const [width, height] of [[1280, 800], [390, 844]]) {
    const { page, close } = await open(browser, { width, height, hash: '#device=eam_mt&node=1' });
    await page.getByRole('button', { name: 'Share and save' }).click();
    await page.getByRole('dialog', { name: 'Share and save' }).waitFor();
    assert.deepEqual(await faults(page), [], `sharing, ${width}`);
    await page.keyboard.press('Escape');
    if (width < 1024) await page.getByRole('tab', { name: 'Objects' }).click();
    await page.getByRole('searchbox', { name: 'Search objects' }).fill('6001');
    await page.getByRole('listbox', { name: 'Objects with their live values' }).getByRole('option').filter({ hasText: '6001h' }).click();
    assert.deepEqual(await faults(page), [], `an object, ${width}`);
    await page.getByRole('button', { name: 'PDO mapping' }).click();
    const dialog = page.getByRole('dialog', { name: 'PDO mapping' });
    await dialog.locator('.mapping-steps li').first().waitFor();
    await dialog.getByRole('button', { name: /^Send/ }).click();
    await dialog.getByText('✓').first().waitFor();
    assert.deepEqual(await faults(page), [], `the mapping, ${width}`);
    await close();
  }
});

test('keys alone: from part to part, to the filter, to an object and its value', async () => {
  const { page, close } = await open(browser, {});
  await booted(page);
  const focused = () => page.evaluate(() => document.activeElement.getAttribute('aria-label') ?? document.activeElement.id);
  const seen = [];
  for (let i = 0; i < 5; i++) {
    await page.keyboard.press('F6');
    seen.push(await focused());
  }
  assert.deepEqual(seen.slice(0, 4), ['Shaft', 'Objects with their live values', 'Captured frames, oldest first', 'raw-frame']);
  await page.keyboard.press('F6');
  assert.equal(await focused(), 'Shaft');
  await page.keyboard.press('/');
  assert.equal(await focused(), 'Filter frames');
  await page.getByRole('searchbox', { name: 'Search objects' }).fill('6001');
  await page.getByRole('listbox', { name: 'Objects with their live values' }).focus();
  await page.keyboard.press('ArrowDown');
  await page.keyboard.press('Enter');
  assert.equal(await focused(), 'New value');
  await page.keyboard.type('1000');
  await page.keyboard.press('Enter');
  await row(page, 'the download', (one) => one.id === '601' && one.data.startsWith('23 01 60 00 E8 03'));
  await close();
});

test('the keyboard reaches every control, in a sensible order', async () => {
  const { page, close } = await open(browser, {});
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
  const order = ['Stop time', 'Power', 'Shaft', 'Search objects', 'Frame', 'Object', 'Read', 'Write', 'NMT Start'].map((name) => names.indexOf(name));
  assert.ok(order.every((place) => place >= 0), `all in ${names}`);
  assert.deepEqual([...order].sort((a, b) => a - b), order);
  await close();
});
