// The browser and the page for a test, in the state of a first visit.
import { chromium } from 'playwright-core';

export const URL_OF_PAGE = process.env.ODKIT_URL ?? 'http://127.0.0.1:8080/';
const executablePath = process.env.CHROMIUM ?? '/usr/bin/chromium';

/** Pages of Chromium's address bar, which it loads with every window: as much work as one of our tests. */
const ADDRESS_BAR = ['WebUIOmniboxPopup', 'WebUIOmniboxAimPopup', 'WebUIOmniboxFullPopup'];
/** Features that Playwright turns off; Chromium reads only the last list. */
const BY_PLAYWRIGHT = ['AvoidUnnecessaryBeforeUnloadCheckSync', 'DestroyProfileOnBrowserClose', 'HttpsUpgrades', 'HttpsFirstBalancedModeAutoEnable', 'LensOverlay', 'MediaRouter', 'PaintHolding', 'ThirdPartyStoragePartitioning', 'AvoidCorsURLLoaderRestartOnRedirect', 'OptimizationHints', 'NetworkTimeServiceQuerying', 'AimEnabled', 'PreconnectToSearch'];
const ARGS = ['--headless', '--no-sandbox', '--disable-gpu', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync', `--disable-features=${[...ADDRESS_BAR, ...BY_PLAYWRIGHT]}`];

export const launch = () => chromium.launch({ executablePath, args: ARGS });

/** The open pages, and their errors. */
export const opened = new Map();

/** An empty page in a context of its own. Motion is reduced, so that a test need not wait for fading elements. */
export async function blank(browser, { width = 1280, height = 800, ...context } = {}) {
  const own = await browser.newContext({ viewport: { width, height }, acceptDownloads: true, reducedMotion: 'reduce', ...context });
  // A busy machine may need this number of milliseconds.
  own.setDefaultTimeout(60_000);
  const page = await own.newPage();
  const fault = (text) => opened.get(page)?.push(text);
  page.on('console', (message) => message.type() === 'error' && fault(message.text()));
  page.on('pageerror', (error) => fault(String(error)));
  page.on('requestfailed', (request) => {
    const why = request.failure()?.errorText;
    // A page that is left or reloaded drops its pending requests.
    if (why !== 'net::ERR_ABORTED') fault(`${request.url()} ${why}`);
  });
  page.on('close', () => opened.delete(page));
  return page;
}

/** Goes to the page; returns its errors: console errors, exceptions, failed requests. */
export async function visit(page, hash = '') {
  const faults = [];
  opened.set(page, faults);
  await page.goto(new URL(hash, URL_OF_PAGE).href);
  return faults;
}

/** Opens the page in a context of its own. */
export async function open(browser, { hash, ...context } = {}) {
  const page = await blank(browser, context);
  return { page, faults: await visit(page, hash), close: () => page.context().close() };
}
