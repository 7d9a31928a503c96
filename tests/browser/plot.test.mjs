// Objects over time.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { becomes, booted, captured, number, until } from './bench.mjs';
import { open } from './check.mjs';

/** Number of pixels of a chart with the colour of its line, from left to right. */
const columns = (page, n) =>
  page.locator('.plot-area').nth(n).evaluate((area) => {
    const canvas = area.querySelector('canvas');
    const [red, green, blue] = getComputedStyle(area).color.match(/[\d.]+/g).map(Number);
    const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
    const found = new Set();
    for (let at = 0; at < data.length; at += 4) {
      const isLine = data[at + 3] > 100 && Math.abs(data[at] - red) + Math.abs(data[at + 1] - green) + Math.abs(data[at + 2] - blue) < 40;
      if (isLine) found.add((at / 4) % canvas.width);
    }
    return found.size;
  });

test('position and speed are drawn while the shaft turns, and any other object', async () => {
  const { page, faults, close } = await open();
  try {
    await booted(page);
    const loaded = () => page.evaluate(() => performance.getEntriesByType('resource').map(({ name }) => name).join(' '));
    const first = await loaded();
    await page.getByRole('spinbutton', { name: 'Speed' }).fill('60');
    await page.keyboard.press('Enter');
    const frames = await captured(page);
    await page.getByRole('button', { name: 'Plot', exact: true }).click();
    await becomes('charts', () => page.locator('.plot-area canvas').count(), 2);
    assert.notEqual(await loaded(), first, 'the plots are fetched when they are wanted');
    const position = page.getByRole('img', { name: /^6004h Position value: .* to / });
    await becomes('the range of the position', () => position.count(), 1);
    for (const n of [0, 1]) await until(`a line in chart ${n}`, async () => (await columns(page, n)) > 20);
    await becomes('the speed', () => number(page, 'Shaft speed in rpm now'), 60);
    const before = await number(page, '6004h Position value now');
    await until('another position', async () => (await number(page, '6004h Position value now')) !== before);

    await page.getByRole('combobox', { name: 'Plot an object' }).selectOption(String(0x6001 * 256));
    await becomes('charts', () => page.locator('.plot-area canvas').count(), 3);
    await becomes('its value', () => page.locator('.plot figcaption .num').nth(4).textContent(), /8.?192|4.?096/);
    await page.getByRole('combobox', { name: 'Time shown' }).selectOption('0');
    await page.getByRole('button', { name: /^Take 6004h/ }).click();
    await becomes('charts', () => page.locator('.plot-area canvas').count(), 2);
    await becomes('charts of 6004h', () => page.getByRole('img', { name: /^6004h/ }).count(), 0);
    assert.equal(await captured(page), frames, 'a plot puts nothing on the bus');

    await page.getByRole('button', { name: 'In order', exact: true }).click();
    await becomes('plots', () => page.locator('od-plot').count(), 0);
    assert.deepEqual(faults, []);
  } finally {
    await close();
  }
});
