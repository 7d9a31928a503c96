// The page, used like a user would.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { get } from 'node:http';
import { test } from 'node:test';
import { becomes, booted, captured, clock, framesOf, nmt, position, row, rows, sdo, sdoNote, sendRaw, state, stays, stopTime, until } from './bench.mjs';
import { checks } from './check.mjs';
import { URL_OF_PAGE } from './harness.mjs';

const check = checks(booted);

const boots = async (page) => (await rows(page)).filter((one) => one.id === '701').length;

check('the node boots and says so', async (page) => {
  const boot = await booted(page);
  assert.equal(boot.dir, 'Rx');
  assert.match(boot.words, /boot-?up/i);
  await becomes('the state', () => state(page), 'Pre-operational');
  await becomes('the lamp', () => page.locator('.led-words').textContent(), /Green flashing/);
});

check('a quiet bus says what to try', async (page) => {
  await page.getByRole('button', { name: 'Read the position' }).click();
  await row(page, 'the answer', (one) => one.id === '581' && one.data.startsWith('43 04 60 00'));
  await page.getByRole('button', { name: 'Start the node' }).click();
  await becomes('the state', () => state(page), 'Operational');
  await becomes('hints', () => page.locator('.hints').count(), 0);
});

check('the first minute: what this is, and a tour that ends in lesson 1', async (page) => {
  await page.getByText('This is a CANopen encoder on a CAN bus, simulated in your browser').waitFor();
  await page.getByRole('button', { name: '60-second tour' }).click();
  const tour = page.getByRole('region', { name: 'Tour' });
  await tour.getByRole('button', { name: 'Start the node' }).click();
  await tour.getByRole('button', { name: 'Run at 30 rpm' }).click();
  await tour.getByRole('button', { name: 'I see them' }).click();
  await tour.getByRole('button', { name: 'Begin lesson 1' }).click();
  await becomes('the address', () => page.url(), /#lesson=boot-up-and-heartbeat/);
  await becomes('the tour', () => tour.count(), 0);
});

check('one line takes a candump line, 29 bits, and an object by index or name', async (page) => {
  for (const [text, id, data] of [
    ['(1436509052.249713) can0 601#4000100000000000', '601', '40 00 10 00 00 00 00 00'],
    ['  can0  601   [8]  40 08 10 00 00 00 00 00', '601', '40 08 10 00 00 00 00 00'],
    ['18FF50E5#01 02', '18FF50E5', '01 02'],
    ['1018:4', '601', '40 18 10 04 00 00 00 00'],
    ['1018h:02', '601', '40 18 10 02 00 00 00 00'],
    ['6004', '601', '40 04 60 00 00 00 00 00'],
    ['Position value', '601', '40 04 60 00 00 00 00 00'],
  ]) {
    await sendRaw(page, text);
    await row(page, text, (one) => one.id === id && one.data === data);
    await page.getByRole('button', { name: 'Clear' }).click();
  }
});

check('Enter reads in the object field, and writes in the value field', async (page) => {
  const object = page.getByRole('combobox', { name: 'Object', exact: true });
  await object.fill('6001');
  await object.press('Enter');
  await becomes('the value', () => sdoNote(page), /6001h = /);
  const value = page.getByRole('textbox', { name: 'Value', exact: true });
  await value.fill('1000');
  await value.press('Enter');
  await becomes('the confirmation', () => sdoNote(page), /6001h written/);
  await sendRaw(page, '601#40');
  await row(page, 'a short request in words', (one) => /1 byte, but an SDO message has 8/.test(one.words));
  await sendRaw(page, 'nmt start all');
  await row(page, 'NMT in words', (one) => one.words === 'Start, all nodes');
});

check('a request typed by hand gets its answer', async (page) => {
  await sendRaw(page, '601#4004600000000000');
  await row(page, 'the request in words', (one) => one.id === '601' && one.dir === 'Tx' && /6004/.test(one.words));
  const answer = await row(page, 'the answer', (one) => one.id === '581' && one.tag === 'SDO' && one.data.startsWith('43 04 60 00 '));
  const bytes = answer.data.split(' ').slice(4).map((byte) => Number.parseInt(byte, 16));
  await becomes('the position', () => position(page), bytes.reduceRight((value, byte) => value * 256 + byte, 0));
});

check('typed frames may be loose, and are checked as they are typed', async (page) => {
  const line = page.getByRole('textbox', { name: 'Frame', exact: true });
  const note = page.locator('#raw-note');
  for (const [text, fault] of [
    ['601#4', ''],
    ['601#40 0x', 'hexadecimal'],
    ['800#00', '7FF'],
    ['zz', 'hexadecimal'],
    ['601#001122334455667788', '8 bytes'],
  ]) {
    await line.fill(text);
    if (fault) await until(`“${fault}” under “${text}”`, async () => (await note.textContent()).includes(fault));
    await becomes(`aria-invalid of ${text}`, () => line.getAttribute('aria-invalid'), String(fault !== ''));
  }
  await sendRaw(page, '601 40 00 10 00');
  await row(page, 'the answer of 1000h', (one) => one.id === '581' && one.data.startsWith('43 00 10 00'));
  await line.press('ArrowUp');
  await becomes('the send line', () => line.inputValue(), '601 40 00 10 00');
});

check('NMT start makes PDOs run, stop silences them', async (page) => {
  await nmt(page, 'Start');
  await becomes('the state', () => state(page), 'Operational');
  await row(page, 'a PDO1 in words', (one) => one.id === '181' && one.tag === 'PDO1' && /position/i.test(one.words));
  const before = (await rows(page)).filter((one) => one.id === '181').length;
  await until('more PDOs', async () => (await rows(page)).filter((one) => one.id === '181').length > before + 1);
  await nmt(page, 'Stop');
  await becomes('the state', () => state(page), 'Stopped');
  await stays(page, 'the number of frames', () => captured(page), 1200);
  await sdo(page, '6004');
  await becomes('no answer', () => sdoNote(page), /No response/);
});

check('the shaft turns by key', async (page) => {
  const shaft = page.getByRole('slider', { name: 'Shaft' });
  await shaft.focus();
  await page.keyboard.press('Home');
  await becomes('the zero point', () => shaft.getAttribute('aria-valuenow'), '0.0');
  const start = await position(page);
  await page.keyboard.press('ArrowRight');
  await becomes('degrees', () => shaft.getAttribute('aria-valuenow'), '5.0');
  await until('6004h to follow', async () => Math.abs((await position(page)) - start - (8192 * 5) / 360) <= 1);
  await page.keyboard.press('PageUp');
  await until('a turn more', async () => Math.abs((await position(page)) - start - 8192 - (8192 * 5) / 360) <= 1);
  await page.keyboard.press('Shift+ArrowLeft');
  await becomes('a tenth of a degree less', () => shaft.getAttribute('aria-valuenow'), '4.9');
});

check('the shaft turns by pointer, more than once round', async (page) => {
  const shaft = page.getByRole('slider', { name: 'Shaft' });
  await shaft.focus();
  await page.keyboard.press('Home');
  await becomes('the zero point', () => shaft.getAttribute('aria-valuenow'), '0.0');
  const start = await position(page);
  const box = await shaft.boundingBox();
  const at = (degrees) => {
    const angle = (degrees * Math.PI) / 180;
    return [box.x + box.width / 2 + 70 * Math.sin(angle), box.y + box.height / 2 - 70 * Math.cos(angle)];
  };
  await page.mouse.move(...at(0));
  await page.mouse.down();
  for (let degrees = 0; degrees <= 540; degrees += 15) await page.mouse.move(...at(degrees));
  await page.mouse.up();
  await until('one and a half turns', async () => Math.abs((await position(page)) - start - 8192 * 1.5) < 60);
});

check('the shaft runs at a speed', async (page) => {
  const before = await position(page);
  const rpm = page.getByRole('spinbutton', { name: 'Speed' });
  await rpm.fill('600');
  await rpm.press('Enter');
  await until('a moving position', async () => Math.abs((await position(page)) - before) > 8192);
  await rpm.fill('0');
  await rpm.press('Enter');
  await stays(page, 'the position', () => position(page), 300);
});

check('power off silences the node, power on boots it', async (page) => {
  await nmt(page, 'Start');
  await row(page, 'a PDO1', (one) => one.id === '181');
  const power = page.getByRole('switch', { name: 'Power' });
  await power.click();
  await becomes('the state', () => state(page), 'Off');
  await becomes('the lamp', () => page.locator('.led-words').textContent(), /no supply/);
  await stays(page, 'the number of frames', () => captured(page), 900);
  await sdo(page, '6004');
  await becomes('a word about the power', () => sdoNote(page), /power is off/);
  // The sixteen attempts without an acknowledgement have pushed the first boot-up out of view.
  const before = Math.max(...(await rows(page)).map((one) => one.time));
  await power.click();
  await row(page, 'the second boot-up', (one) => one.id === '701' && one.time > before);
  await becomes('the state', () => state(page), 'Pre-operational');
});

check('reset node boots again', async (page) => {
  await page.getByRole('button', { name: 'Reset node', exact: true }).first().click();
  await becomes('boot-ups', () => boots(page), 2);
});

check('pause holds the view and loses nothing', async (page) => {
  await nmt(page, 'Start');
  await row(page, 'a PDO1', (one) => one.id === '181');
  await page.locator('.frames').focus();
  await page.keyboard.press('Space');
  await until('the mark of the pause', () => page.getByText(/^Paused/).isVisible());
  // The last frames before the pause are still being drawn.
  const shown = await stays(page, 'the number of rows', async () => (await rows(page)).length, 200);
  const count = await captured(page);
  await until('frames behind the pause', async () => (await captured(page)) >= count + 2);
  assert.equal((await rows(page)).length, shown);
  await page.keyboard.press('Space');
  await until('the frames of the pause', async () => (await rows(page)).length >= shown + 2);
});

check('a chosen frame is shown in full and goes back to the send line', async (page) => {
  await sendRaw(page, '601 40 08 10 00');
  await row(page, 'the answer', (one) => one.id === '581');
  await framesOf(page, '581').click();
  const detail = page.locator('.frame-detail');
  await becomes('its object', () => detail.textContent(), /1008h/);
  await becomes('its value', () => detail.textContent(), /GXMM/);
  await page.locator('.frames').press('ArrowUp');
  await becomes('the frame before', () => detail.textContent(), /Read 1008h/);
  await detail.getByRole('button', { name: 'To send line' }).click();
  const line = page.getByRole('textbox', { name: 'Frame', exact: true });
  await becomes('the send line', () => line.inputValue(), '601#40 08 10 00');
  await page.locator('.frames').press('Escape');
  await becomes('details', () => detail.count(), 0);
});

check('SYNC fetches the synchronous PDO', async (page) => {
  await nmt(page, 'Start');
  for (let i = 0; i < 2; i++) await page.getByRole('button', { name: 'SYNC', exact: true }).click();
  await row(page, 'PDO2', (one) => one.id === '281' && one.tag === 'PDO2');
});

check('clear empties the console', async (page) => {
  await page.getByRole('button', { name: 'Clear' }).click();
  await until('no rows', async () => (await rows(page)).length === 0 && (await captured(page)) === 0);
  await sendRaw(page, '601#4004600000000000');
  await row(page, 'a new frame', (one) => one.id === '581');
});

check('save writes a candump log', async (page) => {
  await sendRaw(page, '601#4004600000000000');
  await row(page, 'the answer', (one) => one.id === '581');
  await sendRaw(page, '701#R');
  await row(page, 'the remote frame', (one) => one.data.includes('remote'));
  const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'Save log' }).click()]);
  assert.match(download.suggestedFilename(), /\.log$/);
  const lines = (await readFile(await download.path(), 'utf8')).trimEnd().split('\n');
  for (const line of lines) assert.match(line, /^\(\d+\.\d{6}\) can0 [0-9A-F]{3}#([0-9A-F]{2}){0,8}$|#R\d?$/);
  assert.ok(lines.some((line) => line.endsWith('601#4004600000000000')));
  assert.ok(lines.some((line) => /581#43046000/.test(line)));
  assert.ok(lines.some((line) => line.endsWith('701#R')));
});

check('scrolling up holds the place, one button goes back to the end', async (page) => {
  const speed = page.getByRole('combobox', { name: 'Speed' });
  await nmt(page, 'Start');
  await speed.selectOption('100');
  await until('many frames', async () => (await captured(page)) > 300);
  await page.locator('.frames').hover();
  await page.mouse.wheel(0, -600);
  await until('the way back', () => page.getByRole('button', { name: 'Latest frames' }).isVisible());
  // 400 milliseconds of real time, at this speed.
  const first = await stays(page, 'the first row', async () => (await rows(page))[0].number, 40_000);
  await page.getByRole('button', { name: 'Latest frames' }).click();
  await until('the newest rows', async () => (await rows(page)).at(-1).number > first + 60);
});

check('the wheel holds the list before the browser has scrolled it', async (page) => {
  await nmt(page, 'Start');
  await page.getByRole('combobox', { name: 'Speed' }).selectOption('100');
  await until('many frames', async () => (await captured(page)) > 300);
  const latest = page.getByRole('button', { name: 'Latest frames' });
  const turn = (deltaY) => page.locator('.frames').evaluate((list, deltaY) => list.dispatchEvent(new WheelEvent('wheel', { deltaY, bubbles: true })), deltaY);
  await turn(-1);
  await latest.waitFor();
  await stays(page, 'the last row', async () => (await rows(page)).at(-1).number, 40_000);
  await latest.click();
  await latest.waitFor({ state: 'detached' });
  await turn(1);
  const last = (await rows(page)).at(-1).number;
  await until('the newest rows', async () => (await rows(page)).at(-1).number > last + 60);
});

check('time pauses and continues by steps', async (page) => {
  await stopTime(page);
  const before = await clock(page);
  await page.getByRole('button', { name: 'Step 1 millisecond' }).click();
  await becomes('the clock', () => clock(page), before + 1);
  await page.getByRole('button', { name: 'Run time' }).click();
  await until('time to run', async () => (await clock(page)) > before + 1);
});

check('while time is paused, nothing is drawn', async (page) => {
  await stopTime(page);
  const drawn = () =>
    page.evaluate(async () => {
      let base = customElements.get('od-app').prototype;
      while (!Object.hasOwn(base, 'scheduleUpdate')) base = Object.getPrototypeOf(base);
      const { scheduleUpdate } = base;
      let count = 0;
      base.scheduleUpdate = function () {
        count += 1;
        return scheduleUpdate.call(this);
      };
      for (let i = 0; i < 20; i++) await new Promise((resolve) => setTimeout(resolve, 10));
      base.scheduleUpdate = scheduleUpdate;
      return count;
    });
  await until('a page that draws nothing', async () => (await drawn()) === 0);
  await page.getByRole('button', { name: 'Learn' }).click();
  await page.getByRole('button', { name: 'Fault cases' }).click();
  await page.locator('od-fault-cases .card').first().waitFor();
  await until('a list of cases that draws nothing', async () => (await drawn()) === 0);
});

check('light and dark', async (page) => {
  const background = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const light = await background();
  await page.getByRole('button', { name: 'Light or dark' }).click();
  await until('another colour', async () => (await background()) !== light);
  const dark = await background();
  await page.reload();
  await booted(page);
  await becomes('the choice is kept', background, dark);
});

check('dark where the system is dark', { colorScheme: 'dark' }, async (page) => {
  await until('a dark page', async () => {
    const [red] = (await page.evaluate(() => getComputedStyle(document.body).backgroundColor)).match(/\d+/g).map(Number);
    return red < 40;
  });
});

/** The status of the page and its headers, under this host name. */
const head = (host, path = '') =>
  new Promise((resolve, reject) => {
    const request = get(new URL(path, URL_OF_PAGE), { headers: { host } }, (response) => {
      response.resume();
      resolve([response.statusCode, response.headers]);
    });
    request.on('error', reject);
  });

test('the server answers to its own names only, and sends the policy of the page', async () => {
  const { port } = new URL(URL_OF_PAGE);
  for (const name of ['127.0.0.1', 'localhost']) {
    const [status, headers] = await head(`${name}:${port}`);
    assert.equal(status, 200, name);
    const policy = headers['content-security-policy'];
    assert.match(policy, /default-src 'none'; script-src 'self' 'wasm-unsafe-eval' 'sha256-[^']+';/);
    assert.match(policy, /connect-src 'self' ws:\/\/127\.0\.0\.1:\* ws:\/\/localhost:\*;/);
    assert.doesNotMatch(policy.replace(/ ws:\/\/[\w.]+:\*/g, ''), /\*|http|script-src[^;]*'unsafe-(inline|eval)'/);
  }
  const [, worker] = await head(`127.0.0.1:${port}`, 'worker.js');
  assert.match(worker['content-security-policy'], /script-src 'self' 'wasm-unsafe-eval';/);
  for (const name of ['odkit.example', `odkit.example:${port}`, '127.0.0.1', `127.0.0.1:${port}.example`]) {
    assert.equal((await head(name))[0], 421, name);
  }
  for (const path of ['..%2f..%2fpackage.json', 'missing.js']) assert.equal((await head(`127.0.0.1:${port}`, path))[0], 404, path);
});
