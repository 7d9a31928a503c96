// Measures the page: `cargo xtask play --no-serve`, then `node measure.mjs`.
// It serves the bundle itself and prints a Markdown table; a missed aim gives exit code 1.
import { execFileSync } from 'node:child_process';
import { readFile } from 'node:fs/promises';
import { cpus, loadavg } from 'node:os';
import { serve } from '../../playground/web/serve.mjs';
import { launch } from './harness.mjs';
import { once } from 'node:events';
import WebSocket from 'ws';
import { simulated } from './odkit.mjs';
import { booted, nmt, sdo, sdoNote, until } from './bench.mjs';

const WEB = new URL('../../playground/web/', import.meta.url);
const server = await serve(WEB, 0);
const url = `${server.url}dist/`;

const load = loadavg()[0];
const table = [];
const row = (what, value, unit, aim, isMet) => table.push({ what, value: `${value} ${unit}`, aim, isMet });
const round = (value) => Math.round(value).toLocaleString('en');

/** HTML, scripts, styles and module of a first visit. */
function firstLoad() {
  let text;
  try {
    text = execFileSync(process.execPath, ['size.mjs'], { cwd: WEB, encoding: 'utf8' });
  } catch (error) {
    // Over the budget it ends with 1, after printing the size.
    text = String(error.stdout);
  }
  const size = Number(/first load\s+([\d.]+) kB/.exec(text)?.[1]);
  row('First load, gzip', size.toFixed(1), 'kB', 'at most 250 kB', size <= 250);
}

const context = async (browser) => browser.newContext({ viewport: { width: 1280, height: 800 }, serviceWorkers: 'block' });

/** From the start of the navigation to the boot-up message in the console, with empty caches, five times. */
async function interactive(browser) {
  const times = [];
  for (let run = 0; run < 5; run++) {
    const own = await context(browser);
    const page = await own.newPage();
    await page.addInitScript(() => {
      const look = () => {
        if (document.querySelector('.frame:not([hidden])')) globalThis.readyAt = performance.now();
        else requestAnimationFrame(look);
      };
      requestAnimationFrame(look);
    });
    await page.goto(url);
    times.push(await page.waitForFunction(() => globalThis.readyAt).then((handle) => handle.jsonValue()));
    await own.close();
  }
  const median = times.sort((a, b) => a - b)[2];
  row('Interactive after a cold local load (median of 5)', round(median), 'ms', 'under 1,000 ms', median < 1000);
}

/** Virtual seconds per second, without a page; `period` of the PDO in milliseconds. */
async function simulation(browser, period, aim) {
  const own = await context(browser);
  const page = await own.newPage();
  await page.goto(`${url}icon.svg`);
  const rate = await page.evaluate(async (cycle) => {
    const { default: init, Bus } = await import('/src/wasm/od_playground.js');
    await init();
    const bus = new Bus();
    bus.setRpm(bus.addDevice('gxmm', 1), 60);
    bus.send(0x601, new Uint8Array([0x2b, 0x00, 0x18, 5, cycle & 0xff, cycle >> 8, 0, 0]), false, false);
    bus.send(0, new Uint8Array([1, 1]), false, false);
    const run = (milliseconds) => {
      const from = performance.now();
      const start = bus.now();
      while (performance.now() - from < milliseconds) {
        bus.advance(60e6, 5000);
        bus.drain();
      }
      return (bus.now() - start) / 1000 / (performance.now() - from);
    };
    run(300);
    return run(3000);
  }, period);
  await own.close();
  row(`One moving node, a PDO every ${period} ms: virtual seconds per second`, round(rate), '×', aim ? `at least ${round(aim)} ×` : '–', rate >= aim);
}

/** A PDO every 2 virtual milliseconds at ten times the speed: 5,000 frames per second. */
async function throughput(browser) {
  const own = await context(browser);
  const page = await own.newPage();
  await page.goto(url);
  await booted(page);
  await sdo(page, '1800:05', '2');
  await until('the answer', async () => /written/.test(await sdoNote(page)));
  await page.getByRole('combobox', { name: 'Speed' }).selectOption('10');
  await nmt(page, 'Start');
  await page.waitForTimeout(500);
  const seen = await page.evaluate(
    () =>
      new Promise((resolve) => {
        let longest = 0;
        let pictures = 0;
        new PerformanceObserver((list) => list.getEntries().forEach((entry) => (longest = Math.max(longest, entry.duration)))).observe({ type: 'longtask' });
        const captured = () => Number(document.querySelector('[aria-label="Captured frames"]').textContent.replace(/\D/g, ''));
        const from = performance.now();
        const before = captured();
        const next = () => {
          pictures += 1;
          const passed = performance.now() - from;
          if (passed < 8000) return requestAnimationFrame(next);
          const rates = { frames: ((captured() - before) * 1000) / passed, pictures: (pictures * 1000) / passed };
          // The observer reports the last long task a little later.
          return setTimeout(() => resolve({ longest, ...rates }), 200);
        };
        next();
      }),
  );
  const download = page.waitForEvent('download');
  await page.getByRole('button', { name: 'Save log' }).click();
  const log = await readFile(await (await download).path(), 'utf8');
  await own.close();
  const times = [...log.matchAll(/^\((\d+\.\d+)\) \S+ 181#/gm)].map(([, time]) => Number(time));
  let dropped = 0;
  for (let i = 1; i < times.length; i++) dropped += Math.max(0, Math.round((times[i] - times[i - 1]) / 0.002) - 1);
  // Whole refreshes are counted, so a second may have a few frames less.
  row('Frames per second through the console', round(seen.frames), '', 'at least 5,000', seen.frames >= 4950);
  row(`Frames dropped of ${round(times.length)}`, dropped, '', 'none', dropped === 0 && times.length > 20_000);
  row('Longest task during that', seen.longest ? round(seen.longest) : 'under 50', 'ms', 'at most 100 ms', seen.longest <= 100);
  row('Rendered frames per second during that', round(seen.pictures), '', 'at least 50', seen.pictures >= 50);
}

/** 5,000 frames per second of a real bus: another client of `odkit sim` sends them, the page shows them. */
async function real(browser) {
  const bus = await simulated(['gxmm']);
  const own = await context(browser);
  const page = await own.newPage();
  await page.goto(`${url}#bus=${bus.found}`);
  await page.locator('.topbar .real-mark').waitFor();
  const other = new WebSocket(bus.found);
  await once(other, 'open');
  other.send('O\r');
  const captured = () => page.evaluate(() => Number(document.querySelector('[aria-label="Captured frames"]').textContent.replace(/\D/g, '')));
  const pictures = page.evaluate(
    () =>
      new Promise((resolve) => {
        const from = performance.now();
        let count = 0;
        const next = () => (performance.now() - from < 8000 ? ((count += 1), requestAnimationFrame(next)) : resolve((count * 1000) / (performance.now() - from)));
        next();
      }),
  );
  const from = performance.now();
  const second = 5000;
  let sent = 0;
  while (performance.now() - from < 8000) {
    const due = Math.floor(((performance.now() - from) / 1000) * second) - sent;
    if (due > 0) other.send('t18181122334455667788\r'.repeat(due));
    sent += due;
    await new Promise((resolve) => setTimeout(resolve, 4));
  }
  const drawn = await pictures;
  const seen = await captured();
  await until('all frames', async () => (await captured()) === sent);
  row('Real bus over WebSocket: CAN frames per second', round(seen / 8), '', 'at least 5,000', seen / 8 >= 4950);
  row('Real bus: rendered frames per second during that', round(drawn), '', 'at least 50', drawn >= 50);
  other.close();
  await own.close();
  await bus.stop();
}

/** The longest task of the page while a user types in an EDS of 560 kB with 700 findings. */
async function typing(browser) {
  const own = await context(browser);
  const page = await own.newPage();
  await page.goto(url);
  await booted(page);
  await page.evaluate(() => {
    const object = (i) => `[${(0x2000 + i).toString(16)}]\nParameterName=Value ${i}\nObjectType=0x7\nDataType=0x0007\nAccessType=rw\nDefaultValue=${i % 7 ? i : 'none'}\nPDOMapping=0\n\n`;
    const text = `[FileInfo]\nFileName=large.eds\n\n${Array.from({ length: 5200 }, (_, i) => object(i)).join('')}`;
    const dataTransfer = new DataTransfer();
    dataTransfer.items.add(new File([text], 'large.eds'));
    document.body.dispatchEvent(new DragEvent('drop', { dataTransfer, bubbles: true, cancelable: true }));
  });
  await page.getByRole('button', { name: 'Open in the editor' }).click();
  await page.locator('.editor-side .finding').first().waitFor();
  await page.keyboard.press('Control+End');
  await page.waitForTimeout(1000);
  await page.evaluate(() => {
    globalThis.longest = 0;
    new PerformanceObserver((list) => list.getEntries().forEach(({ duration }) => (globalThis.longest = Math.max(globalThis.longest, duration)))).observe({ type: 'longtask' });
  });
  await page.keyboard.type('ParameterName=Typed while it is checked', { delay: 60 });
  await page.waitForTimeout(1500);
  const longest = await page.evaluate(() => globalThis.longest);
  await own.close();
  row('Longest task while typing in an EDS of 560 kB', longest ? round(longest) : 'under 50', 'ms', 'under 50 ms', !longest);
}

/** Processor time of all processes of the browser, in percent of one processor: while only the clock changes, and while time is paused. */
async function rest(browser) {
  const own = await context(browser);
  const page = await own.newPage();
  await page.goto(url);
  await booted(page);
  const session = await browser.newBrowserCDPSession();
  const used = async () => (await session.send('SystemInfo.getProcessInfo')).processInfo.reduce((sum, { cpuTime }) => sum + cpuTime, 0);
  const share = async () => {
    await page.waitForTimeout(3000);
    const [from, before] = [performance.now(), await used()];
    await page.waitForTimeout(8000);
    return (((await used()) - before) * 100_000) / (performance.now() - from);
  };
  const running = await share();
  await page.getByRole('button', { name: 'Pause time' }).click();
  const paused = await share();
  await own.close();
  row('Processor time of Chromium while only time passes', running.toFixed(0), '% of a processor', 'at most 15 %', running <= 15);
  row('Processor time of Chromium while time is paused', paused.toFixed(1), '% of a processor', 'at most 1 %', paused <= 1);
}

const browser = await launch();
try {
  firstLoad();
  await interactive(browser);
  await simulation(browser, 100, 5000);
  await simulation(browser, 10, 5000);
  // Without an aim: the speed of the busiest bench.
  await simulation(browser, 1, 0);
  await throughput(browser);
  await real(browser);
  await typing(browser);
  await rest(browser);
} finally {
  await browser.close();
  await server.stop();
}
console.log(`Chromium ${browser.version()}, ${cpus().length} processors, load ${load.toFixed(1)} before the run\n`);
console.log('| what | measured | aim |\n|---|--:|---|');
for (const { what, value, aim, isMet } of table) console.log(`| ${what} | ${value.trim()} | ${aim}${isMet ? '' : ': missed'} |`);
if (table.some(({ isMet }) => !isMet)) process.exitCode = 1;
