// Causes of a hanging page: a worker that does not respond, an endless script, a slow server.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { becomes, booted, captured, position, row, sendRaw, state, until } from './bench.mjs';
import { browser, checks } from './check.mjs';
import { URL_OF_PAGE } from './harness.mjs';

const check = checks(booted);

/** A page whose worker hangs when the fault `name` is set, `times` times. */
async function hangs(times) {
  const context = await browser.newContext({ serviceWorkers: 'block' });
  const page = await context.newPage();
  await page.route('**/worker.js', async (route) => {
    const answer = await route.fetch();
    const trap = times-- > 0 ? "addEventListener('message',({data})=>{if(data.op==='do'&&data.input.op==='fault')for(;;);});" : '';
    await route.fulfill({ response: answer, body: `${trap}${await answer.text()}` });
  });
  await page.goto(URL_OF_PAGE);
  await booted(page);
  return { page, close: () => context.close() };
}

test('a worker that hangs is ended; the bench is as it was before', async () => {
  const { page, close } = await hangs(1);
  try {
    await sendRaw(page, '601#23 01 60 00 E8 03 00 00');
    await row(page, 'the confirmation', (one) => one.id === '581' && one.data.startsWith('60'));
    await page.getByRole('slider', { name: 'Shaft' }).press('PageUp');
    await until('the shaft to turn', async () => (await position(page)) > 0);
    const [at, count] = [await position(page), await captured(page)];
    await page.getByRole('button', { name: 'Hardware' }).click();
    await page.getByRole('button', { name: 'Battery low' }).click();
    await until('a word about it', () => page.getByText('did not answer for 2 s').isVisible());
    await page.getByRole('button', { name: 'Shaft', exact: true }).click();
    await becomes('the frames', () => captured(page), count);
    await becomes('the position', () => position(page), at);
    await sendRaw(page, '601#40 01 60 00');
    await row(page, 'the value that was written', (one) => one.id === '581' && one.data.startsWith('43 01 60 00 E8 03'));
  } finally {
    await close();
  }
});

check('a line that would take for ever is refused with its limit', async (page) => {
  for (const [text, message] of [
    ['power cycle 1000000000s', 'the limit is 600s'],
    ['power cycle 11min', 'the limit is 600s'],
  ]) {
    await sendRaw(page, text);
    await until(`a message about ${text}`, () => page.getByText(message).isVisible());
    await becomes('the state', () => state(page), 'Pre-operational');
  }
});

test('a slow lesson leaves an empty bench, and opens when it has loaded', async () => {
  const context = await browser.newContext({ serviceWorkers: 'block' });
  const page = await context.newPage();
  let go;
  const gone = new Promise((resolve) => (go = resolve));
  await page.route('**/slow.md', async (route) => {
    await gone;
    await route.fulfill({ response: await route.fetch({ url: new URL('lesson-nmt.md', URL_OF_PAGE).href }) });
  });
  try {
    await page.goto(new URL('?lesson=slow.md', URL_OF_PAGE).href);
    await until('a word about it', () => page.getByText('is still loading').isVisible());
    await booted(page);
    await sendRaw(page, '601#40 00 10 00');
    await row(page, 'an answer', (one) => one.id === '581');
    go();
    await page.locator('od-lesson h2').first().waitFor();
  } finally {
    await context.close();
  }
});

test('markup and scripts by address pass through Trusted Types', async () => {
  const context = await browser.newContext({ serviceWorkers: 'block' });
  const page = await context.newPage();
  try {
    await page.goto(URL_OF_PAGE);
    await booted(page);
    const tried = await page.evaluate(() => {
      const failed = (act) => {
        try {
          act();
          return '';
        } catch (error) {
          return error.name;
        }
      };
      return [
        failed(() => (document.createElement('div').innerHTML = '<b></b>')),
        failed(() => new Worker('main.js')),
        failed(() => trustedTypes.createPolicy('another', {})),
      ];
    });
    assert.deepEqual(tried, ['TypeError', 'TypeError', 'TypeError']);
    const meta = await page.locator('meta[http-equiv=Content-Security-Policy]').getAttribute('content');
    assert.match(meta, /default-src 'none'.*require-trusted-types-for 'script'/);
  } finally {
    await context.close();
  }
});
