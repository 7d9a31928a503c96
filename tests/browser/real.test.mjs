// A real bus in the page: over WebSocket against `odkit sim`, and through an adapter.
import assert from 'node:assert/strict';
import { afterEach, test } from 'node:test';
import { flawless } from './axe.mjs';
import { becomes, booted, captured, nmt, row, rows, sdo, sdoNote, sendRaw, until } from './bench.mjs';
import { withAdapter } from './adapter.mjs';
import { browser, open } from './check.mjs';
import { adapted, simulated } from './odkit.mjs';

/** The programs of the current test. */
const running = [];
const started = async (starting) => {
  const one = await starting;
  running.push(one);
  return one;
};
const sim = (...args) => started(simulated(...args));
afterEach(() => Promise.all(running.splice(0).map((one) => one.stop())));

const dialog = (page) => page.getByRole('dialog', { name: /Real bus|Connect to a real bus/ });
const mark = (page) => page.locator('.topbar .real-mark');
const problem = (page) => dialog(page).getByRole('alert').textContent();

async function dial(page, address) {
  await page.getByRole('button', { name: 'Connect to a real bus' }).click();
  await dialog(page).getByRole('textbox', { name: 'Address' }).fill(address);
  await dialog(page).getByRole('button', { name: 'Connect', exact: true }).click();
}

async function connect(page, address) {
  await dial(page, address);
  await mark(page).waitFor();
}

/** The page holds frames back until the worker has confirmed that sending is on. */
async function turnOn(page) {
  const sending = page.getByRole('switch', { name: 'Sending' });
  await sending.click();
  await becomes('sending', () => sending.getAttribute('aria-checked'), 'true');
}

/** A test with a page of its own. Its console may report a failed connection, since the browser does. */
const on = (name, body, options) =>
  test(name, async () => {
    const { page, faults, close } = await open(options);
    try {
      await body(page);
      assert.deepEqual(faults.filter((fault) => !/ERR_CONNECTION_REFUSED|WebSocket|403|net::ERR_FAILED/.test(fault)), [], 'the page complained');
    } finally {
      await close();
    }
  });

on('a list of adapters that is closed without a choice says what to check', async (page) => {
  await booted(page);
  await page.evaluate(() => {
    const requestPort = async () => {
      throw new DOMException('No port selected by the user.', 'NotFoundError');
    };
    Object.defineProperty(navigator.serial, 'requestPort', { value: requestPort });
  });
  await page.getByRole('button', { name: 'Connect to a real bus' }).click();
  await dialog(page).getByRole('button', { name: 'Choose adapter' }).click();
  await becomes('the note', () => problem(page), /^No adapter was chosen\. .*as a serial port/);
});

on('a bus over WebSocket is shown, marked in red, and nothing is sent before somebody says so', async (page) => {
  const { found } = await sim(['gxmm', '--node-id', '5']);
  await booted(page);
  const before = await captured(page);
  await connect(page, found);
  await becomes('the mark', () => mark(page).innerText(), /Real bus/);
  await flawless(page, 'a real bus');
  for (const name of ['Pause time', 'Step back one frame', 'Share and save']) assert.equal(await page.getByRole('button', { name }).isVisible(), false, name);
  await nmt(page, 'Start');
  await page.getByText('Sending to the real bus is off.').waitFor();
  assert.deepEqual(await rows(page), [], 'nothing was sent');
  await turnOn(page);
  await sendRaw(page, '605#40 00 10 00');
  const answer = await row(page, 'the answer of node 5', (one) => one.id === '585');
  assert.equal(answer.dir, 'Rx');
  assert.match(answer.data, /^43 00 10 00 96 01/);
  await mark(page).click();
  await dialog(page).getByRole('button', { name: 'Back to the virtual bench' }).click();
  await mark(page).waitFor({ state: 'detached' });
  await until('the virtual bench with its frames', async () => (await captured(page)) >= before);
  await row(page, 'the boot-up of the virtual node', (one) => one.id === '701');
});

on('what keeps a page from a bus is said in words, and the virtual bench goes on', async (page) => {
  const { found } = await sim(['gxmm']);
  const gone = await sim(['gxmm']);
  await gone.stop();
  await booted(page);
  const { port } = new URL(found);
  for (const [address, words] of [
    ['', /Paste the address/],
    ['ws://192.168.1.7:29538/?token=0123456789abcdef', /this computer only/],
    [`ws://127.0.0.1:${port}/`, /no token/],
    [found.replace(/token=.*/, 'token=0123456789abcdef'), /the token is wrong/],
    [gone.found, /Nothing answers at 127.0.0.1:/],
  ]) {
    if (!(await dialog(page).isVisible())) await page.getByRole('button', { name: 'Connect to a real bus' }).click();
    await dialog(page).getByRole('textbox', { name: 'Address' }).fill(address);
    await dialog(page).getByRole('button', { name: 'Connect', exact: true }).click();
    await becomes(`the reason for ${address}`, () => problem(page), words);
  }
  await flawless(page, 'the dialog', 'dialog[open]');
  await page.keyboard.press('Escape');
  await sendRaw(page, '601#40 00 10 00');
  await row(page, 'the answer of the virtual node', (one) => one.id === '581');
});

on('a connection that is cut comes back, with sending off', async (page) => {
  const token = '?token=0123456789abcdef';
  const first = await sim(['gxmm'], 0, token);
  const { port } = new URL(first.found);
  await booted(page);
  await connect(page, first.found);
  await turnOn(page);
  await nmt(page, 'Reset node');
  await row(page, 'the boot-up', (one) => one.id === '701');
  const before = await captured(page);
  await first.stop();
  await becomes('the mark', () => mark(page).innerText(), /Connection lost/);
  assert.equal(await captured(page), before, 'what was seen stays');
  await sim(['gxmm'], port, token);
  await becomes('the mark', () => mark(page).getAttribute('data-status'), 'open');
  const sending = page.getByRole('switch', { name: 'Sending' });
  assert.equal(await sending.getAttribute('aria-checked'), 'false');
  await turnOn(page);
  await sendRaw(page, '601#40 00 10 00');
  await row(page, 'the answer', (one) => one.id === '581');
});

on('every frame of a burst arrives and is counted', async (page) => {
  const { found } = await sim(['gxmm']);
  await booted(page);
  await connect(page, found);
  const burst = 3000;
  const line = 't30081122334455667788\r';
  const other = await page.evaluate(async ([address, lines]) => {
    const own = new WebSocket(address);
    await new Promise((resolve, reject) => Object.assign(own, { onopen: resolve, onerror: reject }));
    own.send('O\r');
    for (const text of lines) own.send(text);
    return own.readyState;
  }, [found, Array.from({ length: burst / 100 }, () => line.repeat(100))]);
  assert.equal(other, 1);
  await becomes('the frames', () => captured(page), burst);
  await mark(page).click();
  await becomes('the count', () => dialog(page).innerText(), /3,000 frames received/);
  assert.doesNotMatch(await dialog(page).innerText(), /dropped/);
});

test('the address of the page opens the bus; virtual devices answer a master on it', async () => {
  const { found } = await sim(['gxmm', '--node-id', '9']);
  const { page, close } = await open({ hash: `#bus=${found}` });
  try {
    await mark(page).waitFor();
    await mark(page).click();
    await dialog(page).getByRole('button', { name: 'Back to the virtual bench' }).click();
    await page.getByRole('button', { name: 'Connect to a real bus' }).click();
    await dialog(page).getByRole('checkbox', { name: 'The virtual devices go on the bus too' }).check();
    await dialog(page).getByRole('button', { name: 'Connect', exact: true }).click();
    await mark(page).waitFor();
    // Another master on the same bus.
    await page.evaluate(async (address) => {
      const own = (globalThis.master = new WebSocket(address));
      globalThis.heard = [];
      own.onmessage = ({ data }) => globalThis.heard.push(data);
      await new Promise((resolve) => (own.onopen = resolve));
      own.send('O\rt60184000100000000000\r');
    }, found);
    const heard = () => page.evaluate(() => globalThis.heard.join('').replace(/[^ -~]/g, ' '));
    await row(page, 'the request of the master', (one) => one.id === '601');
    await mark(page).click();
    await becomes('what was held back', () => dialog(page).innerText(), /\d frames held back/);
    assert.doesNotMatch(await heard(), /t581/, 'sending is off');
    await page.keyboard.press('Escape');
    await turnOn(page);
    await becomes('the switch', () => page.getByRole('switch', { name: 'Sending' }).getAttribute('aria-checked'), 'true');
    await page.evaluate(() => globalThis.master.send('t60184000100000000000\r'));
    await becomes('the answer', heard, /t581843001000/);
    await row(page, 'the answer in the page', (one) => one.id === '581');
  } finally {
    await close();
  }
});

on('a search finds the nodes; one of ours has its dictionary, and its values are read', async (page) => {
  const { found } = await sim(['gxmm', '--node-id', '5']);
  await booted(page);
  await connect(page, found);
  await turnOn(page);
  await page.getByRole('button', { name: 'Search for nodes' }).click();
  await page.getByText('1 node answered.').waitFor();
  await page.getByRole('button', { name: 'Show Node 5' }).click();
  await becomes('the device', () => page.locator('.topbar .device-button').innerText(), /gxmm.*node 5/s);
  const object = (index) => page.getByRole('option').filter({ hasText: index }).first();
  await becomes('a value that nobody has read', () => object('1000h').innerText(), /–/);
  await sdo(page, '1000');
  await becomes('the answer', () => sdoNote(page), /1000h = 00020196h/);
  await becomes('the value', () => object('1000h').innerText(), /00020196h/);
  await nmt(page, 'Start');
  await becomes('the state', () => page.getByLabel('NMT state').innerText(), 'Operational');
  // The position comes in PDO1.
  await sdo(page, '1800:05', '10');
  await row(page, 'PDO1 in words', (one) => one.id === '185' && /Position value/.test(one.words));
  assert.equal(await page.getByRole('slider', { name: 'Shaft' }).isVisible(), false, 'the shaft is elsewhere');
  await page.getByRole('button', { name: 'Read all values' }).click();
  await page.getByText(/^(\d+) of \1 read$/).waitFor();
});

test('an adapter over Web Serial: its bus is shown, and it continues after the cable was unplugged', async () => {
  const bus = await started(adapted(['gxmm', '--node-id', '7']));
  const { page, plug, pull, close } = await withAdapter(browser);
  try {
    await booted(page);
    await page.getByRole('button', { name: 'Connect to a real bus' }).click();
    await dialog(page).getByRole('button', { name: 'Choose adapter' }).click();
    await becomes('the reason', () => problem(page), /The port cannot be opened: Failed to open/);
    await plug(null);
    await dialog(page).getByRole('button', { name: 'Choose adapter' }).click();
    await becomes('the reason', () => problem(page), /The adapter does not answer/);
    await plug(bus.found);
    await dialog(page).getByRole('combobox', { name: 'Bit rate of the bus' }).selectOption('125 kbit/s');
    await dialog(page).getByRole('button', { name: 'Choose adapter' }).click();
    await mark(page).waitFor();
    await turnOn(page);
    await sendRaw(page, '607#40 00 10 00');
    await row(page, 'the answer', (one) => one.id === '587' && one.dir === 'Rx');
    const before = await captured(page);
    await pull();
    await becomes('the mark', () => mark(page).innerText(), /Connection lost/);
    await mark(page).click();
    await page.getByText('The adapter was unplugged.').waitFor();
    await page.keyboard.press('Escape');
    await plug(bus.found);
    await becomes('the mark', () => mark(page).getAttribute('data-status'), 'open');
    assert.ok((await captured(page)) >= before, 'what was seen stays');
    await turnOn(page);
    await sendRaw(page, '607#40 18 10 01');
    await row(page, 'the answer', (one) => one.id === '587' && one.data.startsWith('43 18 10 01'));
  } finally {
    await close();
  }
});

on('a lesson works on a real node; one that needs a simulation says what it needs', async (page) => {
  const { found } = await sim(['gxmm']);
  await booted(page);
  await connect(page, found);
  await turnOn(page);
  const lesson = (name) => page.evaluate((hash) => void (location.hash = hash), `#lesson=${name}`);
  await lesson('nmt');
  await page.getByText(/this lesson needs a virtual bench: a step looks at an LED/).first().waitFor();
  await page.keyboard.press('Escape');
  await lesson('aborts');
  await page.locator('od-lesson').waitFor();
  assert.equal(await mark(page).isVisible(), true, 'the bus is still there');
  const steps = [['601#23 00 10 00 01 00 00 00'], ['601#40 55 55 00 00 00 00 00'], ['601#40 18 10 09 00 00 00 00'], ['601#40 01 60 00', '601#23 01 60 00 28 23 00 00'], ['601#2B 01 60 00 E8 03 00 00']];
  for (const [number, frames] of steps.entries()) {
    for (const frame of frames) await sendRaw(page, frame);
    await page.locator('od-lesson .happened').waitFor();
    if (number < steps.length - 1) await page.locator('.lesson-foot .primary').click();
  }
  await page.locator('.lesson-end').waitFor();
});
