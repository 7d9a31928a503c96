// One journey through the page, in each engine: boot, start, turn, SDO, lesson 1, share, reload.
// An ordinary run uses Chromium; a long one also Firefox and WebKit.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { becomes, until } from './bench.mjs';
import { ENGINES } from './engines.mjs';
import { URL_OF_PAGE } from './harness.mjs';

/** The two functions of the page that every engine supports. */
const TOOLS = `
  const all = (selector) => [...document.querySelectorAll(selector)].filter((it) => it.checkVisibility());
  const named = (selector, name) => all(selector).find((it) => (it.getAttribute('aria-label') ?? it.textContent).replaceAll(/\\s+/g, ' ').trim() === name);
  const type = (it, text) => {
    it.focus();
    it.value = text;
    it.dispatchEvent(new Event('input', { bubbles: true }));
  };
  const press = (it, key) => it.dispatchEvent(new KeyboardEvent('keydown', { key, bubbles: true, cancelable: true }));
`;

for (const [name, start] of Object.entries(ENGINES)) {
  if (name !== 'chromium' && !process.env.ODKIT_LONG) continue;
  test(`a journey in ${name}: boot, start, turn, SDO, lesson 1, share, reload`, async () => {
    const { goto, evaluate, close } = await start();
    try {
      const run = (body) => evaluate(`(async () => { ${TOOLS} ${body} })()`);
      const text = (selector) => () => run(`return all(${JSON.stringify(selector)})[0]?.textContent ?? ''`);
      const click = (selector, label) => until(`${label} to click`, () => run(`const it = named(${JSON.stringify(selector)}, ${JSON.stringify(label)}); it?.click(); return !!it`));
      const row = (id, data) => until(`${id}#${data}`, () => run(`return all('.frame').some((it) => it.querySelector('.id').textContent === '${id}' && it.querySelector('.data').textContent.startsWith('${data}'))`));

      await goto(URL_OF_PAGE);
      await row('701', '00');
      await becomes('the state', text('[aria-label="NMT state"]'), 'Pre-operational');
      await click('button', 'NMT Start');
      await becomes('the state', text('[aria-label="NMT state"]'), 'Operational');
      await row('181', '');

      const angle = () => run(`return all('[role=slider]')[0].getAttribute('aria-valuenow')`);
      const before = await angle();
      await run(`press(all('[role=slider]')[0], 'ArrowRight')`);
      await until('the shaft to turn', async () => (await angle()) !== before);

      await run(`const it = document.querySelector('#sdo-object'); type(it, '1018:02'); press(it, 'Escape'); press(it, 'Enter')`);
      await becomes('the product code', text('#sdo-note'), /1018h:02 = /);
      await row('581', '43 18 10 02');

      await click('button', 'Learn');
      await until('the list of lessons', () => run(`const it = all('[aria-labelledby^=level-] .card')[0]; it?.click(); return !!it`));
      const step = text('.lesson-step h3 .num');
      for (let number = 1; number <= 5; number++) {
        await becomes('the step', step, String(number));
        await until('the hints', () => run(`const hint = all('.lesson-foot button').find((it) => /hint$/.test(it.textContent)); hint?.click(); return !hint && !!named('.lesson-foot button', 'Show me')`));
        await click('.lesson-foot button', 'Show me');
        await until('the step to be done', () => run(`return all('.happened').length === 1`));
        if (number < 5) await click('.lesson-foot button', 'Continue');
      }
      await becomes('the end of the lesson', text('.lesson-end'), /You did it/);
      await click('od-lesson button', 'Leave the lesson');

      await click('button', 'Share and save');
      let link = '';
      await until('a link', async () => (link = await run(`return all('dialog input[readonly]')[0]?.value ?? ''`)));
      assert.match(link, /#bench=/);
      const clock = text('[role=timer]');
      await goto(link);
      await becomes('the device of the link', text('.device-button .badge'), 'node 5');
      await until('time to pass', async () => /^00:0[1-9]/.test(await clock()));
      await becomes('the state', text('[aria-label="NMT state"]'), 'Pre-operational');
    } catch (error) {
      error.message += `\n${await evaluate('document.body.innerText').catch(String)}`;
      throw error;
    } finally {
      await close();
    }
  });
}
