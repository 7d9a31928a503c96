// Sharing a bench: by link, by file, after closing the page; without a network; in a frame.
import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { readFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import { test } from 'node:test';
import { deflateRawSync } from 'node:zlib';
import { becomes, booted, captured, file, nmt, pass, position, row, rows, sdo, sdoNote, sendRaw, state, stays, stopTime, until } from './bench.mjs';
import { browser, checks, open } from './check.mjs';
import { URL_OF_PAGE } from './harness.mjs';

const check = checks();

const note = (page, pattern) => becomes('the note under the SDO line', () => sdoNote(page), pattern);

/** Changes state of every kind: values, saved and not, the shaft, the NMT state. */
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
  await becomes('the state', () => state(page), 'Operational');
}

/** The value of an object in the SDO line. */
const read = async (page, object) => {
  await sdo(page, object);
  return (await becomes(`the value of ${object}`, () => sdoNote(page), /= ./)).split('= ')[1];
};

/** Time when this browser last stored a bench, in wall-clock milliseconds; 0 if never. */
const keptAt = (page) =>
  page.evaluate(async () => {
    const answer = (request) => new Promise((resolve, reject) => Object.assign(request, { onsuccess: () => resolve(request.result), onerror: () => reject(request.error) }));
    let newest = 0;
    for (const { name } of await indexedDB.databases()) {
      const database = await answer(indexedDB.open(name));
      for (const store of database.objectStoreNames) {
        for (const { at } of await answer(database.transaction(store).objectStore(store).getAll())) newest = Math.max(newest, at ?? 0);
      }
      database.close();
    }
    return newest;
  });

/** The bench of `use`, on another page. */
async function isUsed(page, at) {
  await becomes('the state', () => state(page), 'Operational');
  await becomes('the position', () => position(page), at);
  assert.match(await read(page, '6001'), /^1\u2009?000/);
  assert.match(await read(page, '2300:01'), /^77/);
  // Values that were not saved are lost without power, saved ones stay.
  const power = page.getByRole('switch', { name: 'Power' });
  await power.click();
  await becomes('the state', () => state(page), 'Off');
  await power.click();
  await becomes('the state', () => state(page), 'Pre-operational');
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

check('a link without the run brings the bench as it is', async (page) => {
  await use(page);
  const at = await position(page);
  const hash = await linkOf(page);
  assert.ok(hash.length < 4000, `${hash.length} characters`);
  const other = await open({ hash });
  await becomes('the state', () => state(other.page), 'Operational');
  assert.ok((await rows(other.page)).every((one) => one.id === '181' || one.id === '701'), 'no frame of the past');
  await isUsed(other.page, at);
  assert.deepEqual(other.faults, []);
  await other.close();
});

check('a link with the run brings every frame again', async (page) => {
  await use(page);
  await stopTime(page);
  const at = await position(page);
  const count = await captured(page);
  const clock = await page.getByRole('timer').textContent();
  const strip = (list) => list.map(({ time, id, data, dir }) => [time, id, data, dir].join(' '));
  await becomes('the newest row', async () => (await rows(page)).at(-1).number, count - 1);
  const before = strip(await rows(page));
  const hash = await linkOf(page, { trace: true });
  const other = await open({ hash });
  await becomes('the moment', () => other.page.getByRole('timer').textContent(), clock);
  await becomes('frames', () => captured(other.page), count);
  await becomes('the rows', async () => strip(await rows(other.page)), before);
  await other.page.getByRole('button', { name: 'Run time' }).click();
  await isUsed(other.page, at);
  assert.deepEqual(other.faults, []);
  await other.close();
});

check('two nodes, switches, a wire without terminators', async (page) => {
  await booted(page);
  await page.getByRole('button', { name: 'Add a node' }).click();
  await page.getByRole('button', { name: /^gxam/ }).click();
  await becomes('nodes', () => page.locator('.topbar .badge').count(), 2);
  const hash = await linkOf(page);
  const other = await open({ hash });
  await becomes('nodes there', () => other.page.locator('.topbar .badge').allTextContents(), ['node 1', 'node 2']);
  await becomes('their devices', () => other.page.locator('.topbar .nodes strong').allTextContents(), ['gxmm', 'gxam']);
  await other.close();
});

check('a dropped EDS, its node and its values go along', async (page) => {
  await booted(page);
  const entry = (index, name, type, access, value) => `[${index}]\nParameterName=${name}\nObjectType=7\nDataType=${type}\nAccessType=${access}\nDefaultValue=${value}\nPDOMapping=0\n`;
  const eds = file('travelled.eds', `[FileInfo]\nFileName=x.eds\n[DeviceInfo]\nProductName=Travelled\n${entry('1000', 'Device type', '0x0007', 'ro', 0)}${entry('1001', 'Error register', '0x0005', 'ro', 0)}${entry('2000', 'Grösse', '0x0006', 'rw', 7)}`);
  await page.locator('.device-button').click();
  await page.getByRole('spinbutton', { name: 'Node ID' }).fill('9');
  await page.getByLabel('EDS or DCF file').setInputFiles(eds);
  const anyway = page.getByRole('button', { name: 'Run anyway' });
  await until('the file or its faults', async () => (await anyway.isVisible()) || /node 9/.test(await page.locator('.topbar').textContent()));
  if (await anyway.isVisible()) await anyway.click();
  await becomes('the node', () => page.locator('.topbar').textContent(), /node 9/);
  await sdo(page, '2000', '321');
  await note(page, /2000h written/);
  for (const trace of [false, true]) {
    const hash = await linkOf(page, { trace });
    const other = await open({ hash });
    await becomes('the node there', () => other.page.locator('.topbar').textContent(), /node 9/);
    assert.match(await read(other.page, '2000'), /^321/);
    assert.deepEqual(other.faults, []);
    await other.close();
  }
});

test('bad links show a message and a new bench', async () => {
  for (const hash of ['#bench=', '#bench=%%%', '#bench=AAAA', '#bench=q1bKz1ayUtJRykvMTVWyUsooKSmw0tcvLy_XSyvNS9dLzs8FAA', '#device=nonsense&node=900', `#${'device=gxam&'.repeat(2000)}`, '#bus=%']) {
    const { page, faults, close } = await open({ hash });
    await booted(page);
    if (hash.startsWith('#bench')) await until(`a message about ${hash}`, () => page.getByText('This link cannot be opened').isVisible());
    if (hash.includes('nonsense')) await until('a message about the device', () => page.getByText('No built-in device is named “nonsense”').isVisible());
    if (hash.includes('gxam')) await until('a message about the devices', () => page.getByText('The address names 2000 devices. The page starts with the first 4.').isVisible());
    if (hash.startsWith('#bus')) await until('a message about the bus', () => page.getByText('This is not an address.').isVisible());
    await becomes('the state', () => state(page), 'Pre-operational');
    assert.deepEqual(faults, []);
    await close();
  }
});

test('a link that exceeds a limit shows a message and a new bench', async () => {
  const bench = (entries, now = 0) => `#bench=${deflateRawSync(JSON.stringify({ odkit: 1, trace: true, now, speed: 1, running: true, node: 0, entries })).toString('base64url')}`;
  const add = { op: 'add', source: { kind: 'builtin', name: 'gxmm' }, nodeId: 1 };
  for (const [hash, message] of [
    [bench(Array.from({ length: 2000 }, () => [0, add])), 'more than 16 devices'],
    [bench([[0, add]], 366 * 86_400e6), 'longer than a day'],
    [bench([[0, add], [0, { op: 'script', text: 'wait 1000000000s' }]]), 'the limit is 600s'],
    [bench([[0, add], [0, { op: 'script', text: 'device gxmm\n'.repeat(2000) }]]), 'the bus has room for 16 devices'],
  ]) {
    const { page, faults, close } = await open({ hash });
    await until(`a message with “${message}”`, () => page.getByText(message).isVisible());
    await booted(page);
    await sendRaw(page, '601#40 00 10 00');
    await row(page, 'an answer', (one) => one.id === '581');
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
  const other = await open();
  await booted(other.page);
  const opening = await shareDialog(other.page);
  const damaged = file('damaged.json', (await readFile(path, 'utf8')).slice(0, 300));
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
  // Later actions are stored together with all earlier ones.
  const used = Date.now();
  await read(page, '1000');
  await until('the bench to be kept', async () => (await keptAt(page)) >= used);
  await page.reload();
  await booted(page);
  await becomes('the position', () => position(page), 0);
  await page.getByRole('button', { name: 'Continue with it' }).click();
  await isUsed(page, at);
  await becomes('what is offered', () => page.getByRole('button', { name: 'Continue with it' }).count(), 0);
  // It is hidden while hints of a lesson are shown.
  await page.reload();
  await page.getByRole('button', { name: 'Continue with it' }).waitFor();
  await page.evaluate(() => (location.hash = '#lesson=sdo'));
  await page.locator('od-lesson .checks').waitFor();
  assert.equal(await page.getByRole('button', { name: 'Continue with it' }).isVisible(), false);
});

check('nothing is offered where nothing was done', async (page) => {
  await booted(page);
  await pass(page, 2500);
  await page.reload();
  await booted(page);
  await pass(page, 400);
  assert.equal(await page.getByRole('button', { name: 'Continue with it' }).count(), 0);
  assert.equal(await keptAt(page), 0);
});

test('it loads without a network after the first visit', async () => {
  const { page, faults, close } = await open({ own: true });
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
  // This includes files that are loaded on request: the module that reads EDS texts.
  const eds = file('offline.eds', '[FileInfo]\nFileName=x.eds\n[DeviceInfo]\nProductName=Offline\n[1000]\nParameterName=Device type\nObjectType=7\nDataType=0x0007\nAccessType=ro\nDefaultValue=0\nPDOMapping=0\n');
  await page.locator('.device-button').click();
  await page.getByLabel('EDS or DCF file').setInputFiles(eds);
  await until('the file in the module that reads it', async () =>
    /Offline/.test(await page.locator('.topbar').textContent()) || (await page.getByRole('alert', { name: 'Findings in the file' }).isVisible()));
  assert.deepEqual(faults, []);
  await close();
});

/** Serves the page as it is, or with files that `change` makes; returns the address. */
async function changed(change) {
  const server = createServer(async (request, response) => {
    const name = new URL(request.url, URL_OF_PAGE).pathname.slice(1);
    const answer = await fetch(new URL(name, URL_OF_PAGE));
    const body = change(name, Buffer.from(await answer.arrayBuffer()));
    response.writeHead(answer.status, { 'content-type': answer.headers.get('content-type') ?? 'application/octet-stream' });
    response.end(body);
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  const close = () => {
    server.closeAllConnections();
    server.close();
  };
  return { url: `http://127.0.0.1:${server.address().port}/`, close };
}

const newIcon = (body) => Buffer.from(body.toString().replace('<svg', '<svg data-new=""'));
const hashOf = (body) => createHash('sha256').update(body).digest('base64url').slice(0, 12);

test('a new version is offered and installed on request; one that is deployed incompletely never is', async () => {
  // The page as it is, and then with another icon: first the list of files is new, then the file.
  const icon = await (await fetch(new URL('icon.svg', URL_OF_PAGE))).arrayBuffer().then(Buffer.from);
  const [listed, there] = [new Set(), new Set()];
  const server = await changed((name, body) => {
    if (listed.has('new') && name === 'sw.js') return Buffer.from(body.toString().replace(/\["icon.svg","[^"]+"\]/, `["icon.svg","${hashOf(newIcon(icon))}"]`));
    return there.has('new') && name === 'icon.svg' ? newIcon(body) : body;
  });
  const page = await browser.newPage();
  const shown = () => page.evaluate(async () => (await fetch('icon.svg')).text());
  /** Checks for a new version until the check ends. */
  const look = () =>
    page.evaluate(async () => {
      const registration = await navigator.serviceWorker.ready;
      await registration.update();
      const worker = registration.installing;
      if (!worker) return registration.waiting ? 'installed' : 'none';
      return new Promise((resolve) => worker.addEventListener('statechange', () => worker.state !== 'installing' && resolve(worker.state)));
    });
  try {
    await page.goto(server.url);
    await booted(page);
    await page.evaluate(() => navigator.serviceWorker.ready);
    await until('the page to be kept', () => page.evaluate(() => navigator.serviceWorker.controller !== null));
    listed.add('new');
    assert.equal(await look(), 'redundant', 'a file of another version is not kept');
    await page.reload();
    await booted(page);
    assert.ok(!(await shown()).includes('data-new'), 'the page is whole');
    there.add('new');
    // Chromium checks for a new version when it is idle. A page that draws continuously on a busy
    // machine may keep it from that for a minute.
    await stopTime(page);
    assert.equal(await look(), 'installed');
    const load = page.getByRole('button', { name: 'Load it' });
    await load.waitFor();
    assert.ok(!(await shown()).includes('data-new'), 'the old version until then');
    await Promise.all([page.waitForNavigation(), load.click()]);
    await booted(page);
    await until('the new version', async () => (await shown()).includes('data-new'));
    assert.equal(await page.evaluate(async () => (await (await caches.open('odkit')).keys()).filter(({ url }) => url.includes('icon.svg')).length), 1, 'the old file is gone');
  } finally {
    await page.close();
    server.close();
  }
});

test('two tabs store a bench each', async () => {
  const context = await browser.newContext();
  const visit = async () => {
    const page = await context.newPage();
    await page.goto(URL_OF_PAGE);
    await booted(page);
    return page;
  };
  const kept = (page) =>
    page.evaluate(async () => {
      const answer = (request) => new Promise((resolve, reject) => Object.assign(request, { onsuccess: () => resolve(request.result), onerror: () => reject(request.error) }));
      const database = await answer(indexedDB.open('odkit'));
      const texts = database.objectStoreNames.contains('kept') ? (await answer(database.transaction('kept').objectStore('kept').getAll())).map(({ text }) => text) : [];
      database.close();
      return texts;
    });
  try {
    const [first, second] = [await visit(), await visit()];
    await sendRaw(first, '601#40 08 10 00');
    await until('the first bench to be kept', async () => (await kept(first)).length === 1);
    await sendRaw(second, '601#40 09 10 00');
    await until('both benches', async () => (await kept(second)).length === 2);
    await sendRaw(first, '601#40 0A 10 00');
    await until('the first bench again', async () => (await kept(first)).some((text) => text.includes('QAgQ') && text.includes('QAoQ')));
    assert.ok((await kept(first)).some((text) => text.includes('QAkQ')), 'the second is as it was');
    assert.equal(await second.getByRole('button', { name: 'Continue with it' }).count(), 0, 'what another tab works on is not offered');
  } finally {
    await context.close();
  }
});

test('in a frame of another page it has fewer elements', async () => {
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
    await until('the whole page', () => opened.locator('od-encoder').isVisible());
    await becomes('the address', () => opened.url(), /#bench=/);
  } finally {
    await page.close();
    host.close();
  }
});
