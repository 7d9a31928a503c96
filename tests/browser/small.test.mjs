// Regression tests for small faults.
import assert from 'node:assert/strict';
import { becomes, booted, nmt, row, sdo, until } from './bench.mjs';
import { checks } from './check.mjs';

const check = checks();

/** Returns whether a control is where it is drawn, and nothing covers it. */
const isFree = (control) =>
  control.evaluate((it) => {
    it.scrollIntoView({ block: 'center' });
    const { left, top, width, height } = it.getBoundingClientRect();
    const there = document.elementFromPoint(left + width / 2, top + height / 2);
    return it.contains(there);
  });

for (const [width, height] of [[1366, 625], [390, 844]]) {
  check(`a list of suggestions covers none of the next fields, ${width}`, { width, height }, async (page) => {
    if (width < 1024) await page.getByRole('tab', { name: 'Bus' }).click();
    await booted(page);
    await page.getByRole('combobox', { name: 'Object', exact: true }).fill('60');
    await page.locator('#sdo-options').waitFor();
    const next = [page.getByRole('button', { name: 'Read', exact: true }), page.getByRole('textbox', { name: 'Value', exact: true }), page.getByRole('button', { name: 'Write', exact: true })];
    for (const control of next) assert.ok(await isFree(control), String(control));
  });
}

for (const [width, height] of [[390, 844], [640, 400], [800, 900]])
  check(`the checks and the buttons of a step are above the bar of panels, and no message covers them, ${width} pixels wide`, { hash: '#lesson=nmt', width, height }, async (page) => {
    const bar = await page.getByRole('tablist').boundingBox();
    const foot = page.locator('.lesson-foot');
    const isAbove = async (name) => {
      const box = await foot.getByRole('button', { name, exact: true }).boundingBox();
      return box && box.y + box.height <= bar.y;
    };
    await until('the hint above the bar', () => isAbove('A hint'));
    const checks = await foot.locator('.checks').boundingBox();
    assert.ok(checks.y >= 0 && checks.y + checks.height <= bar.y, 'the checks are in sight');
    await page.evaluate(() => scrollTo(0, document.documentElement.scrollHeight));
    assert.ok(await isAbove('A hint'), 'at the end of the page, too');
    await page.getByRole('tab', { name: 'Bus' }).click();
    await nmt(page, 'Start');
    const told = page.getByText('Step 1 is done.');
    await told.waitFor();
    await page.getByRole('tab', { name: 'Lesson' }).click();
    await told.waitFor({ state: 'detached' });
    await until('the next button above the bar', () => isAbove('Continue'));
  });

check('a long checklist is short in a low window, and scrolls', { hash: '#lesson=master', width: 640, height: 400 }, async (page) => {
  const checks = page.locator('.lesson-foot .checks');
  await becomes('the conditions', () => checks.locator('li').count(), 5);
  const { height } = await checks.boundingBox();
  assert.ok(height <= 70, `${height} pixels`);
  await checks.focus();
  await page.keyboard.press('End');
  await until('the last one', () => checks.evaluate((it) => it.scrollTop > 0 && it.scrollTop + it.clientHeight >= it.scrollHeight - 1));
});

check('four nodes on two lines leave the buttons of a step in the window', { hash: '#lesson=does-not-follow', width: 1024, height: 768 }, async (page) => {
  const hint = page.locator('.lesson-foot').getByRole('button', { name: 'A hint', exact: true });
  await hint.waitFor();
  await becomes('pixels below the window', () => page.evaluate(() => document.documentElement.scrollHeight - innerHeight), 0);
  const { y, height } = await hint.boundingBox();
  assert.ok(y + height <= 768, `${y + height}`);
});

/** A log whose seventh frame is an abort. */
const LOG = Array.from({ length: 200 }, (_, i) => `(${(1 + i / 20).toFixed(6)}) can0 ${i === 6 ? '581#8005200000000206' : ['601#4004600000000000', '705#05', '085#3081110000000000'][i % 3]}`).join('\n');

for (const [width, height] of [[1366, 625], [1024, 768], [640, 400], [390, 844]])
  check(`a found frame is in sight beside its detail, and tables fit into the panel, ${width}`, { width, height }, async (page) => {
    if (width < 1024) await page.getByRole('tab', { name: 'Bus' }).click();
    await booted(page);
    await page.evaluate((text) => {
      const dataTransfer = new DataTransfer();
      dataTransfer.items.add(new File([text], 'a-machine-with-a-long-name-2026-11-28.log'));
      document.body.dispatchEvent(new DragEvent('drop', { dataTransfer, bubbles: true, cancelable: true }));
    }, LOG);
    await page.getByRole('button', { name: 'Open beside it' }).click();
    await page.getByText('200 frames are in the console').waitFor();
    await page.locator('.frames').press('Control+f');
    const find = page.getByRole('textbox', { name: 'Find', exact: true });
    await find.fill('abort');
    await find.press('Enter');
    await page.locator('.frame-detail .fields').waitFor();
    const isInSight = () => page.locator('.frame[data-chosen]').evaluate((row) => {
      const [one, list] = [row, row.closest('.frames')].map((it) => it.getBoundingClientRect());
      return one.top >= list.top - 1 && one.bottom <= list.bottom + 1;
    });
    await until('the row of the frame', isInSight);
    for (const [view, table] of [['By CAN-ID', '.ids'], ['Nodes', '.node-list']]) {
      await page.getByRole('group', { name: 'View' }).getByRole('button', { name: view }).click();
      await page.locator(`${table} tbody tr`).first().waitFor();
      await becomes(`pixels beside ${view}`, () => page.locator(table).evaluate((it) => it.scrollWidth - it.clientWidth), 0);
    }
  });

check('hidden texts make no page taller than its window', { width: 1280, height: 800 }, async (page) => {
  await booted(page);
  for (const view of ['Hardware', 'EEPROM', 'Shaft']) {
    await page.getByRole('group', { name: 'Encoder views' }).getByRole('button', { name: view }).click();
    await becomes(`pixels below the window: ${view}`, () => page.evaluate(() => document.documentElement.scrollHeight - innerHeight), 0);
  }
});

check('a mapping that is full says so by its entries, not by its bits', {}, async (page) => {
  await booted(page);
  await page.getByRole('button', { name: 'PDO mapping' }).click();
  const dialog = page.getByRole('dialog', { name: 'PDO mapping' });
  await becomes('why nothing can be added', () => dialog.getByRole('combobox', { name: 'Add an object' }).locator('option').first().textContent(), /^All \d+ mapping entr(y is|ies are) in use/);
});

check('the status bar is under the table by CAN-ID, with nothing over it', { width: 1366, height: 625 }, async (page) => {
  await booted(page);
  await sdo(page, '6004');
  await nmt(page, 'Start');
  await row(page, 'a PDO', (one) => one.id === '181');
  await page.getByRole('button', { name: 'By CAN-ID' }).click();
  const bar = page.locator('.bus-status');
  await until('the table', () => page.locator('.ids').count());
  const [table, under] = await Promise.all([page.locator('.ids').boundingBox(), bar.boundingBox()]);
  assert.ok(under.y >= table.y + table.height - 1, `${under.y} is above ${table.y + table.height}`);
  assert.ok(await isFree(bar.locator('.num').first()));
});
