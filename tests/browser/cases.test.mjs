// The fault cases: probes, the mark, the link with its seed, and German.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { flawless } from './axe.mjs';
import { becomes, until } from './bench.mjs';
import { checks, open } from './check.mjs';

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
  await cases.getByRole('button', { name: 'Check my answer' }).click();
  await cases.getByText('Choose a cause first.').waitFor();
  await cases.getByRole('radio').first().check();
  await cases.getByRole('button', { name: 'Check my answer' }).click();
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
    await probe('Check my answer').click();
    const mark = cases.locator('.case-mark');
    await mark.getByText('probes prove it').waitFor();
    assert.equal(await cases.locator('.case-told').count(), 4);
    if (await mark.getByText('Right.', { exact: true }).count()) break;
    assert.ok(cause < 3, 'one of the causes is right');
    // The same seed is the same case: the readings are those of before.
    await page.evaluate(() => sessionStorage.clear());
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

check('a reload and another language keep the probes, the answer and its mark of a fault case', { hash: '#case=no-answer&seed=3' }, async (page) => {
  const cases = page.locator('od-fault-cases');
  const made = () => cases.locator('.case-probes > li[data-made=true]').count();
  await cases.getByRole('button', { name: 'Look at the trace for 3 s' }).click();
  await becomes('the probe', made, 1);
  await cases.getByRole('radio').nth(1).check();
  await page.reload();
  await becomes('the probe after the reload', made, 1);
  await becomes('the answer', () => cases.getByRole('radio').nth(1).isChecked(), true);
  await cases.getByRole('button', { name: 'Check my answer' }).click();
  await cases.locator('.case-mark').waitFor();
  await page.getByRole('dialog').getByRole('button', { name: 'DE Deutsch' }).click();
  await cases.getByRole('heading', { name: 'Knoten 4 antwortet nicht' }).waitFor();
  await cases.locator('.case-mark').waitFor();
  await becomes('the probe in German', made, 1);
  // Another seed begins again.
  await cases.getByRole('button', { name: 'Andere Ursache auslosen' }).first().click();
  await becomes('no probe', made, 0);
  await becomes('no answer', () => cases.getByRole('radio', { checked: true }).count(), 0);
});

test('a fault case says that it is being loaded, and its address is that of the lesson when it is left', async () => {
  // A service worker would answer before the route.
  const { page, close } = await open({ hash: '#lesson=nmt', serviceWorkers: 'block' });
  await page.locator('od-lesson .checks').waitFor();
  let go;
  const held = new Promise((resolve) => (go = resolve));
  await page.route('**/cases.en.md', (route) => held.then(() => route.continue()));
  await page.getByRole('button', { name: 'Learn' }).click();
  await page.getByRole('button', { name: 'Fault cases' }).click();
  await page.getByRole('dialog').getByText('Loading…').waitFor();
  go();
  await page.getByRole('button', { name: 'Node 4 does not answer' }).click();
  await page.locator('.case-probes').waitFor();
  await becomes('the address of the case', () => page.url(), /#case=no-answer&seed=\d+$/);
  await page.keyboard.press('Escape');
  await becomes('the address of the lesson', () => page.url(), /#lesson=nmt$/);
  await close();
});
