// One browser, and for each test a page without state of earlier tests.
import assert from 'node:assert/strict';
import { after, afterEach, before, test } from 'node:test';
import { blank, launch, opened, URL_OF_PAGE, visit } from './harness.mjs';

/** The browser of this file. */
export let browser;
before(async () => (browser = await launch()));
after(() => browser?.close());

/** Pages of completed tests: reusing a tab takes half the time of a new one. */
const idle = [];

/** Pages of the current test; those of a failed test are closed. */
const inUse = new Set();
afterEach(async () => {
  for (const page of inUse) await page.context().close();
  inUse.clear();
});

/** A tab without stored data, except for the service worker. */
async function forget(page) {
  await page.mouse.move(0, 0);
  await page.evaluate(() => sessionStorage.clear());
  await page.goto('about:blank');
  const client = await page.context().newCDPSession(page);
  await client.send('Storage.clearDataForOrigin', { origin: new URL(URL_OF_PAGE).origin, storageTypes: 'local_storage,indexeddb' });
  await client.detach();
}

/** Opens the page in the browser of this file. A test that sets more than a size and a colour scheme gets a context of its `own`. */
export async function open({ width = 1280, height = 800, colorScheme = null, hash, own = false, ...context } = {}) {
  const isOwn = own || Object.keys(context).length > 0;
  const page = (isOwn ? null : idle.pop()) ?? (await blank(browser, { width, height, ...context }));
  await page.setViewportSize({ width, height });
  await page.emulateMedia({ colorScheme });
  inUse.add(page);
  const faults = await visit(page, hash);
  const close = async () => {
    opened.delete(page);
    inUse.delete(page);
    if (isOwn) return page.context().close();
    await forget(page);
    idle.push(page);
  };
  return { page, faults, close };
}

/**
 * Makes `check(name, [options,] body)`: a test with a page of its own, which must print nothing to
 * its console. `ready` waits for what each test of the file needs first.
 */
export const checks = (ready = () => {}) => (name, options, body) => {
  if (typeof options === 'function') [options, body] = [{}, options];
  test(name, async () => {
    const { page, faults, close } = await open(options);
    try {
      await ready(page);
      await body(page);
      assert.deepEqual(faults, [], 'the page complained');
    } finally {
      await close();
    }
  });
};
