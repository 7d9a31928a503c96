// A bench passed on: by link, by file, by leaving and coming back; without a network; in a frame.
import assert from 'node:assert/strict';
import { readFile, writeFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { launch, open, URL_OF_PAGE } from './harness.mjs';
import { booted, captured, nmt, position, row, rows, sdo, sdoNote, sendRaw, state, until } from './bench.mjs';

let browser;
before(async () => (browser = await launch()));
after(() => browser?.close());

/** A test with a page of its own, which must not complain on its console. */
function check(name, options, body) {
  if (typeof options === 'function') [options, body] = [{}, options];
  test(name, async () => {
    const { page, faults, close } = await open(browser, options);
    try {
      await body(page);
      assert.deepEqual(faults, [], 'the page complained');
    } finally {
      await close();
    }
  });
}

const note = (page, pattern) => until(`${pattern} under the SDO line`, async () => pattern.test(await sdoNote(page)));

/** Changes something of every kind: values, saved and not, the shaft, the NMT state. */
async function use(page) {
  await booted(page);
  await sdo(page, '6001', '1000');
  await note(page, /6001h written/);
  await sdo(page, '1010:01', '"save"');
  await note(page, /1010h:01 written/);
  await sdo(page, '2300:01', '77');
  await note(page, /2300h:01 written/);
  await page.getByRole('slider', { name: 'Shaft' }).press('PageUp');
  await page.getByRole('slider', { name: 'Shaft' }).press('ArrowRight');
  await nmt(page, 'Start');
  await until('Operational', async () => (await state(page)) === 'Operational');
}

const read = async (page, object) => {
  await sdo(page, object);
  return (await until(`${object}`, async () => /= (.*)/.exec(await sdoNote(page))))[1];
};

/** The bench of `use`, on another page. */
async function isUsed(page, at) {
  await until('Operational', async () => (await state(page)) === 'Operational');
  await until('the shaft', async () => (await position(page)) === at);
  assert.match(await read(page, '6001'), /^1\u2009?000/);
  assert.match(await read(page, '2300:01'), /^77/);
  // What was not saved goes with the power, what was saved stays.
  const power = page.getByRole('switch', { name: 'Power' });
  await power.click();
  await power.click();
  await until('Pre-operational', async () => (await state(page)) === 'Pre-operational');
  assert.match(await read(page, '6001'), /^1\u2009?000/);
  assert.match(await read(page, '2300:01'), /^0/);
}

async function shareDialog(page) {
  await page.getByRole('button', { name: 'Share and save' }).click();
  return page.getByRole('dialog', { name: 'Share and save' });
}

async function linkOf(page, { trace = false } = {}) {
  const dialog = await shareDialog(page);
  const field = dialog.getByRole('textbox', { name: 'Link' });
  const first = await until('a link', () => field.inputValue());
  if (trace) {
    await dialog.getByRole('radio', { name: /whole run/ }).check();
    await until('the other link', async () => (await field.inputValue()) !== first);
  }
  const link = await field.inputValue();
  await page.keyboard.press('Escape');
  return new URL(link).hash;
}

check('a link without the run brings the bench as it stands', async (page) => {
  await use(page);
  const at = await position(page);
  const hash = await linkOf(page);
  assert.ok(hash.length < 4000, `${hash.length} characters`);
  const other = await open(browser, { hash });
  await until('Operational', async () => (await state(other.page)) === 'Operational');
  assert.ok((await rows(other.page)).every((one) => one.id === '181' || one.id === '701'), 'no frame of the past');
  await isUsed(other.page, at);
  assert.deepEqual(other.faults, []);
  await other.close();
});

check('a link with the run brings every frame again', async (page) => {
  await use(page);
  await page.getByRole('button', { name: 'Stop time' }).click();
  const at = await position(page);
  await page.waitForTimeout(300);
  const count = await captured(page);
  const clock = await page.getByRole('timer').textContent();
  const before = await rows(page);
  const hash = await linkOf(page, { trace: true });
  const other = await open(browser, { hash });
  await until('the same moment', async () => (await other.page.getByRole('timer').textContent()) === clock);
  await until('all frames', async () => (await captured(other.page)) === count);
  const strip = (list) => list.map(({ time, id, data, dir }) => [time, id, data, dir].join(' '));
  await until('the same rows', async () => JSON.stringify(strip(await rows(other.page))) === JSON.stringify(strip(before)));
  await other.page.getByRole('button', { name: 'Run time' }).click();
  await isUsed(other.page, at);
  assert.deepEqual(other.faults, []);
  await other.close();
});

check('two nodes, switches, a wire without terminators', async (page) => {
  await booted(page);
  await page.getByRole('button', { name: 'Add a node' }).click();
  await page.getByRole('button', { name: /^gxam/ }).click();
  await until('two nodes', async () => (await page.locator('.topbar .badge').count()) === 2);
  const hash = await linkOf(page);
  const other = await open(browser, { hash });
  await until('two nodes there', async () => (await other.page.locator('.topbar .badge').allTextContents()).join() === 'node 1,node 2');
  assert.deepEqual(await other.page.locator('.topbar .nodes strong').allTextContents(), ['gxmm', 'gxam']);
  await other.close();
});

check('a dropped EDS, its node and its values go along', async (page) => {
  await booted(page);
  const eds = join(tmpdir(), `odkit-share-${process.pid}.eds`);
  const entry = (index, name, type, access, value) => `[${index}]\nParameterName=${name}\nObjectType=7\nDataType=${type}\nAccessType=${access}\nDefaultValue=${value}\nPDOMapping=0\n`;
  await writeFile(eds, `[FileInfo]\nFileName=x.eds\n[DeviceInfo]\nProductName=Travelled\n${entry('1000', 'Device type', '0x0007', 'ro', 0)}${entry('1001', 'Error register', '0x0005', 'ro', 0)}${entry('2000', 'Grösse', '0x0006', 'rw', 7)}`);
  await page.locator('.device-button').click();
  await page.getByRole('spinbutton', { name: 'Node ID' }).fill('9');
  await page.getByLabel('EDS or DCF file').setInputFiles(eds);
  const anyway = page.getByRole('button', { name: 'Run anyway' });
  await until('the file or its faults', async () => (await anyway.isVisible()) || /node 9/.test(await page.locator('.topbar').textContent()), { within: 15_000 });
  if (await anyway.isVisible()) await anyway.click();
  await until('node 9', async () => /node 9/.test(await page.locator('.topbar').textContent()));
  await sdo(page, '2000', '321');
  await note(page, /2000h written/);
  for (const trace of [false, true]) {
    const hash = await linkOf(page, { trace });
    const other = await open(browser, { hash });
    await until('node 9 there', async () => /node 9/.test(await other.page.locator('.topbar').textContent()), { within: 15_000 });
    assert.match(await read(other.page, '2000'), /^321/);
    assert.deepEqual(other.faults, []);
    await other.close();
  }
});

test('bad links get a message and a fresh bench', async () => {
  for (const hash of ['#bench=', '#bench=%%%', '#bench=AAAA', '#bench=q1bKz1ayUtJRykvMTVWyUsooKSmw0tcvLy_XSyvNS9dLzs8FAA', '#device=nonsense&node=900']) {
    const { page, faults, close } = await open(browser, { hash });
    await booted(page);
    if (hash.startsWith('#bench')) await until(`a message about ${hash}`, () => page.getByText('This link holds no bench').isVisible());
    assert.equal(await state(page), 'Pre-operational');
    assert.deepEqual(faults, []);
    await close();
  }
});

check('a file is saved and opened again', async (page) => {
  await use(page);
  const at = await position(page);
  const dialog = await shareDialog(page);
  const [download] = await Promise.all([page.waitForEvent('download'), dialog.getByRole('button', { name: 'Save as file' }).click()]);
  assert.equal(download.suggestedFilename(), 'odkit-gxmm.json');
  const path = await download.path();
  const other = await open(browser);
  await booted(other.page);
  const opening = await shareDialog(other.page);
  const damaged = join(tmpdir(), `odkit-damaged-${process.pid}.json`);
  await writeFile(damaged, (await readFile(path, 'utf8')).slice(0, 300));
  await opening.getByLabel('Saved bench').setInputFiles(damaged);
  await until('a message', () => other.page.getByText(/cannot be opened/).isVisible());
  await opening.getByLabel('Saved bench').setInputFiles(path);
  await until('the dialog to close', async () => !(await opening.isVisible()));
  await isUsed(other.page, at);
  assert.deepEqual(other.faults, []);
  await other.close();
});

check('a bench is kept, and offered at the next visit', async (page) => {
  await use(page);
  const at = await position(page);
  await page.waitForTimeout(3200);
  await page.reload();
  await booted(page);
  assert.equal(await position(page), 0);
  await page.getByRole('button', { name: 'Go on with it' }).click();
  await isUsed(page, at);
  assert.equal(await page.getByRole('button', { name: 'Go on with it' }).count(), 0);
});

check('nothing is offered where nothing was done', async (page) => {
  await booted(page);
  await page.waitForTimeout(2500);
  await page.reload();
  await booted(page);
  await page.waitForTimeout(400);
  assert.equal(await page.getByRole('button', { name: 'Go on with it' }).count(), 0);
});

test('it loads without a network after the first visit', async () => {
  const { page, faults, close } = await open(browser);
  await booted(page);
  await page.evaluate(async () => {
    const { active } = await navigator.serviceWorker.ready;
    if (active.state !== 'activated') await new Promise((resolve) => active.addEventListener('statechange', resolve));
  });
  await page.context().setOffline(true);
  await page.reload();
  await booted(page);
  await sendRaw(page, '601#4000100000000000');
  await row(page, 'an answer', (one) => one.id === '581');
  // Even what is fetched later: the module that reads EDS texts.
  const eds = join(tmpdir(), `odkit-offline-${process.pid}.eds`);
  await writeFile(eds, '[FileInfo]\nFileName=x.eds\n[DeviceInfo]\nProductName=Offline\n[1000]\nParameterName=Device type\nObjectType=7\nDataType=0x0007\nAccessType=ro\nDefaultValue=0\nPDOMapping=0\n');
  await page.locator('.device-button').click();
  await page.getByLabel('EDS or DCF file').setInputFiles(eds);
  await until('the file in the module that reads it', async () =>
    /Offline/.test(await page.locator('.topbar').textContent()) || (await page.getByRole('alert', { name: 'What is wrong with the file' }).isVisible()), { within: 15_000 });
  assert.deepEqual(faults, []);
  await close();
});

test('a new version is offered, and comes when it is wanted', async () => {
  // The page as it is, and then with another icon: one file of another content.
  let isNew = false;
  const server = createServer(async (request, response) => {
    const name = new URL(request.url, URL_OF_PAGE).pathname.slice(1);
    const answer = await fetch(new URL(name, URL_OF_PAGE));
    let body = Buffer.from(await answer.arrayBuffer());
    if (isNew && name === 'sw.js') body = Buffer.from(body.toString().replace(/\["icon.svg","[^"]+"\]/, '["icon.svg","another"]'));
    if (isNew && name === 'icon.svg') body = Buffer.from(body.toString().replace('<svg', '<svg data-new=""'));
    response.writeHead(answer.status, { 'content-type': answer.headers.get('content-type') ?? 'application/octet-stream' });
    response.end(body);
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  const url = `http://127.0.0.1:${server.address().port}/`;
  const page = await browser.newPage();
  const icon = () => page.evaluate(async () => (await fetch('icon.svg')).text());
  try {
    await page.goto(url);
    await booted(page);
    await page.evaluate(() => navigator.serviceWorker.ready);
    await until('the page to be kept', () => page.evaluate(() => navigator.serviceWorker.controller !== null));
    isNew = true;
    await page.reload();
    await booted(page);
    const load = page.getByRole('button', { name: 'Load it' });
    await load.waitFor({ timeout: 20_000 });
    assert.ok(!(await icon()).includes('data-new'), 'the old version until then');
    await Promise.all([page.waitForNavigation(), load.click()]);
    await booted(page);
    await until('the new version', async () => (await icon()).includes('data-new'));
    assert.equal(await page.evaluate(async () => (await (await caches.open('odkit')).keys()).filter(({ url }) => url.includes('icon.svg')).length), 1, 'the old file is gone');
  } finally {
    await page.close();
    server.closeAllConnections();
    server.close();
  }
});

test('in a frame of another page there is less around it', async () => {
  const host = createServer((_, response) => {
    response.setHeader('content-type', 'text/html');
    response.end(`<!doctype html><title>Course</title><iframe src="${URL_OF_PAGE}?embed&view=console&theme=dark" width="700" height="600" title="Encoder"></iframe>`);
  });
  await new Promise((resolve) => host.listen(0, 'localhost', resolve));
  const page = await browser.newPage();
  try {
    await page.goto(`http://localhost:${host.address().port}/`);
    const frame = page.frameLocator('iframe');
    await frame.locator('.frame:not([hidden])').first().waitFor();
    assert.equal(await frame.locator('.brand').isVisible(), false);
    assert.equal(await frame.locator('od-encoder').isVisible(), false);
    assert.equal(await frame.locator('od-console').isVisible(), true);
    assert.equal(await frame.getByRole('button', { name: 'Share and save' }).isVisible(), false);
    const [opened] = await Promise.all([page.context().waitForEvent('page'), frame.getByRole('link', { name: 'Open in a tab of its own' }).click()]);
    await booted(opened).catch(() => undefined);
    await until('the whole page', () => opened.locator('od-encoder').isVisible());
    assert.match(opened.url(), /#bench=/);
  } finally {
    await page.close();
    host.close();
  }
});
