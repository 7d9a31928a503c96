// A replacement for Web Serial: the page's port is a terminal, like that of a USB adapter.
import { constants, openSync } from 'node:fs';
import { ReadStream } from 'node:tty';
import { opened, URL_OF_PAGE } from './harness.mjs';

/** A terminal, read and written in bytes, as a browser opens it. */
const terminal = (path) => new ReadStream(openSync(path, constants.O_RDWR | constants.O_NOCTTY)).setRawMode(true);

/** Opens the page with an adapter; `plug` connects its port to a terminal or to none, `pull` unplugs it. */
export async function withAdapter(browser) {
  const context = await browser.newContext({ viewport: { width: 1366, height: 625 } });
  const page = await context.newPage();
  // A failing test shows the content of the page.
  opened.set(page, []);
  page.on('close', () => opened.delete(page));
  let line = null;
  let isPlugged = false;
  await page.exposeFunction('toAdapter', (text) => void line?.write(text, 'latin1'));
  await page.exposeFunction('isPlugged', () => isPlugged);
  await page.addInitScript(() => {
    const serial = new EventTarget();
    let source;
    const port = Object.assign(new EventTarget(), {
      readable: null,
      writable: null,
      async open() {
        if (!(await globalThis.isPlugged())) throw new DOMException('Failed to open serial port.', 'NetworkError');
        this.readable = new ReadableStream({ start: (controller) => (source = controller) });
        this.writable = new WritableStream({ write: (bytes) => globalThis.toAdapter(String.fromCharCode(...bytes)) });
      },
      async close() {
        this.readable = this.writable = null;
      },
    });
    globalThis.fromAdapter = (text) => source.enqueue(Uint8Array.from(text, (letter) => letter.charCodeAt(0)));
    globalThis.pulled = () => source.error(new DOMException('The device has been lost.', 'NetworkError'));
    globalThis.plugged = () => serial.dispatchEvent(new Event('connect'));
    Object.defineProperty(navigator, 'serial', { value: Object.assign(serial, { requestPort: async () => port }) });
  });
  await page.goto(URL_OF_PAGE);
  return {
    page,
    async plug(path) {
      if (path) {
        line = terminal(path);
        // A terminal whose other end is closed reports an error.
        line.on('error', () => undefined);
        line.on('data', (bytes) => void page.evaluate((text) => globalThis.fromAdapter(text), bytes.toString('latin1')).catch(() => undefined));
      }
      isPlugged = true;
      await page.evaluate(() => globalThis.plugged());
    },
    async pull() {
      isPlugged = false;
      line?.destroy();
      line = null;
      await page.evaluate(() => globalThis.pulled());
    },
    close: async () => {
      line?.destroy();
      await context.close();
    },
  };
}
