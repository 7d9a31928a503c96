// Measures the page: frames through the console, refreshes per second, response to input,
// with a PDO every virtual millisecond at increasing speeds.
import { launch, open } from './harness.mjs';
import { booted, nmt, rows, sdo, until, sdoNote } from './bench.mjs';

const browser = await launch();
const started = Date.now();
const { page, close } = await open(browser);
await booted(page);
console.log(`boot-up on screen after ${Date.now() - started} ms`);
await sdo(page, '1800:05', '1');
await until('the answer', async () => /written/.test(await sdoNote(page)));
await nmt(page, 'Start');
console.log('speed   pictures/s  longest ms  frames/s   virtual s/s  input ms');
for (const speed of ['1', '2', '10', '100', '1000']) {
  await page.getByRole('combobox', { name: 'Speed' }).selectOption(speed);
  await page.waitForTimeout(600);
  const total = async () => (await rows(page)).at(-1)?.number ?? 0;
  const before = await total();
  const clock = async () => (await page.getByRole('timer').textContent()).split(':').reduce((sum, part) => sum * 60 + Number(part), 0);
  const virtual = await clock();
  const from = Date.now();
  const pictures = await page.evaluate(
    () =>
      new Promise((resolve) => {
        let count = 0;
        let longest = 0;
        let last = performance.now();
        const end = last + 3000;
        const next = () => {
          const now = performance.now();
          longest = Math.max(longest, now - last);
          last = now;
          count += 1;
          if (now < end) requestAnimationFrame(next);
          else resolve({ rate: count / 3, longest });
        };
        requestAnimationFrame(next);
      }),
  );
  const seconds = (Date.now() - from) / 1000;
  const frames = ((await total()) - before) / seconds;
  const passed = (await clock()) - virtual;
  const pressed = Date.now();
  const shaft = page.getByRole('slider', { name: 'Shaft' });
  const value = await shaft.getAttribute('aria-valuenow');
  await shaft.press('ArrowRight');
  while ((await shaft.getAttribute('aria-valuenow')) === value) await page.waitForTimeout(2);
  const input = Date.now() - pressed;
  console.log(`${`${speed}×`.padEnd(7)} ${pictures.rate.toFixed(0).padStart(10)} ${pictures.longest.toFixed(0).padStart(11)} ${frames.toFixed(0).padStart(9)} ${(passed / seconds).toFixed(1).padStart(13)} ${String(input).padStart(9)}`);
}
await close();
await browser.close();
