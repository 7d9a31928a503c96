// The labs of the page: the master with its list and chart, and the physics of the bus line.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { becomes, booted } from './bench.mjs';
import { browser, open } from './check.mjs';

const slide = (input, value) =>
  input.evaluate((element, to) => {
    element.value = to;
    element.dispatchEvent(new Event('change', { bubbles: true }));
  }, String(value));

test('the master takes its list, and the chart says where and why a node does not follow', async () => {
  const { page, faults, close } = await open({ hash: '#lesson=does-not-follow' });
  const master = page.locator('od-master');
  const list = master.getByRole('textbox');
  await becomes('the list of the lesson', async () => (await list.inputValue()).split('\n').length, 14);
  await master.getByRole('button', { name: 'Boot', exact: true }).click();
  await becomes('four failures', () => master.locator('.pill').allTextContents(), ['failed', 'failed', 'failed', 'failed']);
  await master.getByText('Error status M: the product code').waitFor();
  await master.getByText('6001h: SDO abort 06090031h').waitFor();
  const failed = master.getByRole('list', { name: 'Boot process of node 5' }).locator('[data-state=failed]');
  assert.match(await failed.textContent(), /^Identity.*stopped here$/);
  await list.fill('slave 5\nexpect 5 1018h:02 = 10\nsync 0x');
  await master.getByRole('button', { name: 'Boot', exact: true }).click();
  await master.getByText(/^Line 3: /).waitFor();
  await list.fill('slave 5\nexpect 5 1018h:02 = 10');
  // A checkpoint has paused the time.
  await page.getByRole('button', { name: 'Run time' }).click();
  await master.getByRole('button', { name: 'Boot', exact: true }).click();
  await becomes('node 5 runs', () => master.locator('.pill').allTextContents(), ['started']);
  assert.deepEqual(faults, [], 'the page complained');
  await close();
});

test('the lab of the line opens from the list of lessons, and a line that is too long has no acknowledgement', async () => {
  const { page, faults, close } = await open();
  await booted(page);
  await page.getByRole('button', { name: 'Learn' }).click();
  await page.getByRole('dialog', { name: 'Lessons' }).getByRole('button', { name: /^Line/ }).click();
  const lab = page.locator('od-lab od-line-lab');
  const length = lab.getByRole('slider', { name: 'Length' });
  await slide(length, (await length.getAttribute('max')) ?? '200');
  await lab.getByText('the sender does not see it').waitFor();
  // Error counters and send lines are in sight beside each other, without scrolling.
  const seen = (locator) => locator.evaluate((it) => {
    const { left, top, width, height } = it.getBoundingClientRect();
    return it.contains(document.elementFromPoint(left + width / 2, top + height - 2));
  });
  for (const [width, height] of [[1024, 768], [1366, 625], [1920, 1080]]) {
    await page.setViewportSize({ width, height });
    for (const part of [lab.getByRole('list', { name: 'Error counters' }), page.locator('od-raw-frame'), page.getByRole('button', { name: 'NMT Start' })]) await becomes(`in sight at ${width}`, () => seen(part), true);
  }
  // A reload of the page opens the lab again, until it is closed.
  await page.reload();
  await lab.waitFor();
  assert.match(page.url(), /#device=gxmm&node=1&lab=line$/);
  await page.getByRole('button', { name: 'Close Line' }).click();
  assert.equal(await page.locator('od-lab').count(), 0);
  assert.match(page.url(), /#device=gxmm&node=1$/);
  assert.deepEqual(faults, [], 'the page complained');
  await close();
});
