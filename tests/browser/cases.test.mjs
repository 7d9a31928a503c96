// The fault cases: probes, the mark, the link with its seed, and German.
import assert from 'node:assert/strict';
import { flawless } from './axe.mjs';
import { becomes, until } from './bench.mjs';
import { checks } from './check.mjs';

const check = checks();

check('a fault case is solved with a probe, and a guess and a proof are distinguished', async (page) => {
  await page.getByRole('button', { name: 'Learn' }).click();
  await page.getByRole('button', { name: 'Fault cases' }).click();
  const cases = page.locator('od-fault-cases');
  await becomes('the list', () => cases.locator('.card').count(), 20);
  await flawless(page, 'the list of cases', 'dialog[open]');
  await cases.getByRole('button', { name: 'Nodes 4 and 6 are dead' }).click();
  await cases.getByRole('heading', { name: 'Nodes 4 and 6 are dead' }).waitFor();
  assert.match(page.url(), /#case=dead-end&seed=\d+$/);
  await cases.getByRole('button', { name: 'Mark' }).click();
  await cases.getByText('Choose a cause first.').waitFor();
  await cases.getByRole('radio').first().check();
  await cases.getByRole('button', { name: 'Mark' }).click();
  await cases.locator('.case-mark').getByText('Your probes do not prove it: 4 causes fit them.').waitFor();
  await flawless(page, 'a mark', 'dialog[open]');
});

check('a link opens the same case again; probes tell what they rule out', { hash: '#case=dead-end&seed=7' }, async (page) => {
  const cases = page.locator('od-fault-cases');
  const probe = (name) => cases.getByRole('button', { name });
  await probe('Look at the trace for 3 s').click();
  await probe('Measure the resistance').click();
  await probe('Measure the supply voltage of node 4').click();
  await probe('Look at the bits').click();
  await becomes('the probes', () => cases.locator('.case-probes > li[data-made=true]').count(), 4);
  const first = await cases.locator('.case-probes').innerText();
  // Nothing on the page names the cause before the mark.
  assert.equal(await cases.locator('[data-is=right], .case-mark').count(), 0);
  for (let cause = 0; ; cause += 1) {
    await cases.getByRole('radio').nth(cause).check();
    await probe('Mark').click();
    const mark = cases.locator('.case-mark');
    await mark.getByText('probes prove it').waitFor();
    assert.equal(await cases.locator('.case-told').count(), 4);
    if (await mark.getByText('Right.', { exact: true }).count()) break;
    assert.ok(cause < 3, 'one of the causes is right');
    // The same seed is the same case: the readings are those of before.
    await page.goto('about:blank');
    await page.goBack();
    for (const name of ['Look at the trace for 3 s', 'Measure the resistance', 'Measure the supply voltage of node 4', 'Look at the bits']) {
      await probe(name).click();
      await until('the reading', async () => (await probe(name).count()) === 0);
    }
    assert.equal(await cases.locator('.case-probes').innerText(), first);
  }
  await probe('All cases').last().click();
  await cases.locator('.done-mark').waitFor();
});

check('a fault case in German, narrow', { hash: '#case=no-answer&seed=3&lang=de', width: 390, height: 844 }, async (page) => {
  const cases = page.locator('od-fault-cases');
  await cases.getByRole('heading', { name: 'Knoten 4 antwortet nicht' }).waitFor();
  await cases.getByRole('button', { name: 'Den Trace 3 s lang ansehen' }).click();
  await cases.locator('li[data-made=true]').waitFor();
  assert.ok(await page.evaluate(() => document.querySelector('dialog[open]').scrollWidth <= document.querySelector('dialog[open]').clientWidth + 1), 'nothing is cut off');
  await flawless(page, 'a case in German', 'dialog[open]');
  await page.keyboard.press('Escape');
  await cases.waitFor({ state: 'detached' });
});
