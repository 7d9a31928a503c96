// One browser per test file, and one page per test.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { launch, open as openIn } from './harness.mjs';

/** The browser of this file. */
export let browser;
before(async () => (browser = await launch()));
after(() => browser?.close());

/** Opens the page in the browser of this file. */
export const open = (options) => openIn(browser, options);

/**
 * Makes `check(name, [options,] body)`: a test with a page of its own, which must not complain on
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
