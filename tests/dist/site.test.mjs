// Page and documents on a simple web server: in a subfolder, and without access to other servers.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { createServer } from 'node:http';
import { extname, join } from 'node:path';
import { after, before, test } from 'node:test';
import { launch, open } from '../browser/harness.mjs';
import { dist } from './room.mjs';

const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.json': 'application/json', '.svg': 'image/svg+xml', '.wasm': 'application/wasm', '.txt': 'text/plain', '.md': 'text/plain', '.png': 'image/png', '.woff2': 'font/woff2' };

// A subfolder of the server.
const FOLDER = '/team/odkit/';
// A request to another server fails.
const NOWHERE = { server: 'http://127.0.0.1:9', bypass: '127.0.0.1' };

let server, browser, url;
before(async () => {
  server = createServer(async (request, response) => {
    const path = decodeURIComponent(new URL(request.url, 'http://localhost').pathname).replace(/\/$/, '/index.html');
    // A browser requests an icon for a text file, too.
    if (path === '/favicon.ico') return response.writeHead(204).end();
    const file = path.startsWith(FOLDER) && join(dist, 'site', path.slice(FOLDER.length));
    const body = file && (await readFile(file).catch(() => null));
    response.writeHead(body ? 200 : 404, { 'content-type': TYPES[extname(path)] ?? 'application/octet-stream' }).end(body ?? '');
  });
  await new Promise((listening) => server.listen(0, '127.0.0.1', listening));
  url = `http://127.0.0.1:${server.address().port}${FOLDER}`;
  browser = await launch();
});
after(async () => {
  await browser?.close();
  server?.close();
  server?.closeAllConnections();
});

/** Opens a page of the site; it must have no errors. */
async function visit(path, look) {
  const { page, faults, close } = await open(browser, { hash: new URL(path, url).href, proxy: NOWHERE });
  await look(page);
  assert.deepEqual(faults, [], path);
  await close();
}

test('the first page leads to the others', () =>
  visit('', async (page) => {
    await page.locator('#mdbook-content, #content').getByRole('heading', { name: 'odkit' }).first().waitFor();
    const picture = page.getByRole('img', { name: /playground/ });
    assert.ok(await picture.evaluate((one) => one.decode().then(() => one.naturalWidth > 0)));
    for (const name of ['Check an EDS', 'Boot-up and heartbeat', 'gxmm', 'Rules for EDS files', 'Changelog']) {
      assert.equal(await page.locator('nav a', { hasText: new RegExp(`^\\s*${name}\\s*$`) }).count(), 1, name);
    }
  }));

test('the search finds the heartbeat, and the page of a rule', async () => {
  for (const [words, wanted] of [['heartbeat', /Heartbeat/i], ['E0412', /E0412/]]) {
    await visit(`?search=${words}`, async (page) => {
      const results = page.locator('#mdbook-searchresults li, #searchresults li');
      await results.first().waitFor();
      assert.match((await results.allInnerTexts()).join('\n'), wanted);
    });
  }
});

test('the bench in a lesson boots', () =>
  visit('lessons/boot-up-and-heartbeat.html', async (page) => {
    const frame = page.frameLocator('iframe.bench');
    await frame.getByRole('heading', { name: 'Power the encoder and find its first frame' }).first().waitFor();
    await frame.getByRole('tab', { name: 'Encoder' }).click();
    await frame.getByRole('switch', { name: 'Power' }).click();
    await frame.getByText('Pre-operational').first().waitFor();
    assert.ok(await page.getByText('Solution').first().isVisible());
  }));

test('the page runs beside the documents', () =>
  visit('playground/', async (page) => {
    await page.getByText('Pre-operational').first().waitFor();
  }));

test('a rule has a page, and a script is a text', async () => {
  await visit('docs/RULES-EDS.html', async (page) => {
    await page.locator('main').getByRole('link', { name: 'E0412', exact: true }).click();
    await page.getByText('DefaultValue=300').first().waitFor();
  });
  await visit('docs/CIA.html', async (page) => {
    await page.locator('main').getByRole('link', { name: 'sdo-01', exact: true }).first().click();
    await page.getByText('601#').first().waitFor();
  });
});
