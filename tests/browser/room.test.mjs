// Layout: in every window each list has four rows, no text is cut, and no element covers another.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { becomes, booted, nmt, row, sdo, sdoNote, sendRaw, until } from './bench.mjs';
import { open } from './check.mjs';
import { URL_OF_PAGE } from './harness.mjs';

const SIZES = [[1920, 1080], [1366, 625], [1280, 800], [1024, 768], [720, 450], [640, 400], [390, 844]];
const EMBEDDED = [['', 900, 600], ['encoder', 420, 520], ['console', 700, 500], ['objects', 420, 420]];

/** Elements that are too small, cut or covered, in words; hidden ones are scrolled to first. */
const cramped = (page) =>
  page.evaluate(() => {
    const faults = [];
    const nameOf = (it) => `${it.tagName.toLowerCase()}.${it.className} “${(it.getAttribute('aria-label') ?? it.textContent).replaceAll(/\s+/g, ' ').trim().slice(0, 60)}”`;
    const isSeen = (it) => it.checkVisibility({ visibilityProperty: true }) && it.getClientRects().length > 0 && !it.closest('.sr');
    const all = [...document.querySelectorAll('body *')].filter(isSeen);
    for (const it of document.querySelectorAll('.frames, .object-rows, .ids, .lesson')) {
      if (!isSeen(it)) continue;
      const height = it.matches('.lesson, .ids') ? 24 : Number.parseFloat(getComputedStyle(it).getPropertyValue('--row-height'));
      if (it.clientHeight < 4 * height) faults.push(`${nameOf(it)} has room for ${(it.clientHeight / height).toFixed(1)} rows`);
    }
    if (document.documentElement.scrollWidth > innerWidth) faults.push(`the page is ${document.documentElement.scrollWidth - innerWidth} pixels too wide`);
    for (const it of all) {
      const style = getComputedStyle(it);
      const cuts = style.overflowX === 'hidden' || style.overflowX === 'clip' || style.textOverflow === 'ellipsis';
      if (cuts && !it.matches('.rows-spacer, .plot-area, select') && it.scrollWidth > it.clientWidth + 1 && it.textContent.trim()) faults.push(`${nameOf(it)} is cut: ${it.clientWidth} of ${it.scrollWidth} pixels`);
      const isControl = it.matches('button, a, select, input:not(.segment input), summary');
      // A label that is larger than its button overflows it.
      if (it.matches('button, summary, .segment span') && (it.scrollWidth > it.clientWidth + 1 || it.scrollHeight > it.clientHeight + 1)) faults.push(`${nameOf(it)} has no room for its label`);
      const isText = [...it.childNodes].some((node) => node.nodeType === Node.TEXT_NODE && node.data.trim());
      if (!isControl && !isText) continue;
      if (it.closest('.row, option, svg')) continue;
      const over = () => {
        const { left, top, width, height } = it.getBoundingClientRect();
        const there = document.elementFromPoint(left + Math.min(width / 2, innerWidth - left - 1), top + height / 2);
        return there && (it.contains(there) || there.contains(it) || it.parentElement.contains(there)) ? null : (there ?? it);
      };
      if (over()) {
        it.scrollIntoView({ block: 'center', inline: 'nearest' });
        const there = over();
        if (there && there !== it) faults.push(`${nameOf(it)} is covered by ${nameOf(there)}`);
      }
      const { width, height } = it.getBoundingClientRect();
      if (innerWidth < 600 && isControl && !it.matches('input[type=checkbox], input[type=radio], .link') && Math.min(width, height) < 39.5) faults.push(`${nameOf(it)} is ${Math.round(width)} × ${Math.round(height)} pixels: too small for a finger`);
    }
    scrollTo(0, 0);
    return [...new Set(faults)];
  });

const roomy = (page, what) => becomes(`what has no room: ${what}`, () => cramped(page), []);

/** Every part of the page, one tab at a time where there are tabs. */
async function everyPart(page, what, rest = () => {}) {
  const tabs = page.getByRole('tab');
  const names = (await tabs.first().isVisible()) ? await tabs.allTextContents() : [''];
  for (const name of names.map((text) => text.trim())) {
    if (name) await page.getByRole('tab', { name }).click();
    await roomy(page, `${what} ${name}`);
    await rest(name);
  }
}

/** A bench with content in every list. */
async function busy() {
  const { page, faults, close } = await open({ width: 1280, height: 800 });
  await booted(page);
  await sdo(page, '6001', '9000');
  await becomes('the abort', () => sdoNote(page), /^Value/);
  await sendRaw(page, '601#23 10 10 01 73 61 76 65');
  await nmt(page, 'Start');
  await row(page, 'a PDO', (one) => one.id === '181');
  return { page, faults, close };
}

test('every list has four rows, and no text is cut or covered, in every window', async () => {
  const { page, faults, close } = await busy();
  const views = page.getByRole('group', { name: 'Encoder views' });
  for (const [width, height] of SIZES) {
    await page.setViewportSize({ width, height });
    const part = async (name) => {
      if (name && name !== 'Encoder') return;
      for (const view of ['Hardware', 'EEPROM', 'Shaft']) {
        await views.getByRole('button', { name: view }).click();
        await roomy(page, `${width}, ${view}`);
      }
    };
    await everyPart(page, `${width} × ${height}`, part);
    if (width < 1024) await page.getByRole('tab', { name: 'Bus' }).click();
    // By its key: a clicked row may have moved.
    await page.locator('.frames').press('Enter');
    await page.locator('.frame-detail').waitFor();
    await roomy(page, `${width}, a frame`);
    await page.getByRole('button', { name: 'Close the frame' }).click();
    await page.getByRole('button', { name: 'By CAN-ID' }).click();
    await roomy(page, `${width}, by CAN-ID`);
    await page.getByRole('button', { name: 'Nodes', exact: true }).click();
    await page.locator('od-node-list td').first().waitFor();
    await roomy(page, `${width}, nodes`);
    await page.getByRole('button', { name: 'Plot', exact: true }).click();
    await page.locator('.plot-area canvas').first().waitFor();
    await roomy(page, `${width}, plots`);
    await page.getByRole('button', { name: 'In order' }).click();
  }
  assert.deepEqual(faults, []);
  await close();
});

test('a lesson shows its step, its checks and the bus without scrolling, beside a bench that is large enough', async () => {
  const { page, faults, close } = await open({ width: 1366, height: 625, hash: '#lesson=sdo' });
  const lesson = page.locator('od-lesson');
  await lesson.locator('.checks').waitFor();
  for (const [width, height] of SIZES) {
    await page.setViewportSize({ width, height });
    await everyPart(page, `lesson ${width}`);
    if (width < 1024) continue;
    const seen = (selector) => lesson.locator(selector).evaluate((it) => {
      const { top, bottom } = it.getBoundingClientRect();
      // A question that moves to another place is drawn again there.
      const box = it.closest('.scroll, .panel')?.getBoundingClientRect();
      return box !== undefined && top >= box.top && bottom <= Math.min(box.bottom, innerHeight) + 1;
    });
    for (const selector of ['.lesson-step h3', '.lesson-step > .prose', '.quiz input', '.checks', '.asked > button.small']) await until(`${selector} in sight at ${width}`, () => seen(selector));
  }
  assert.deepEqual(faults, []);
  await close();
});

test('the layout also holds at 200 % zoom and in each embedded view', async () => {
  const { page, faults, close } = await open({ width: 640, height: 400, deviceScaleFactor: 2, hash: '?embed' });
  for (const [view, width, height] of EMBEDDED) {
    await page.setViewportSize({ width, height });
    if (view) await page.goto(new URL(`?embed&view=${view}`, URL_OF_PAGE).href);
    await until('the devices', () => page.locator('.device-button .badge').count());
    await everyPart(page, `embed ${view}`);
  }
  assert.deepEqual(faults, []);
  await close();
});
