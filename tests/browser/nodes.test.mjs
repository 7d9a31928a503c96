// The bench: several nodes, their switches, faults, EEPROMs and shafts, the bus line, and time.
import assert from 'node:assert/strict';
import { becomes, booted, captured, clock, nmt, number, position, row, rows, sdo, sdoNote, sendRaw, state, stays, stopTime, until } from './bench.mjs';
import { checks } from './check.mjs';

const check = checks(booted);

const part = (page, name) => page.getByRole('group', { name: 'Encoder views' }).getByRole('button', { name }).click();
const note = (page, pattern) => becomes('the note under the SDO line', () => sdoNote(page), pattern);
const written = (page, object, value) => sdo(page, object, value).then(() => note(page, /written/));
const cycle = async (page) => {
  await page.getByRole('switch', { name: 'Power' }).click();
  await becomes('the state', () => state(page), 'Off');
  await page.getByRole('switch', { name: 'Power' }).click();
};

async function addNode(page, name, node) {
  await page.getByRole('button', { name: 'Add a node' }).click();
  const dialog = page.getByRole('dialog');
  if (node) await dialog.getByRole('spinbutton', { name: 'Node ID' }).fill(String(node));
  await dialog.getByRole('button', { name, exact: false }).first().click();
  await until('the dialog to close', async () => !(await dialog.isVisible()));
}

check('up to four nodes, each with its own panels', {}, async (page) => {
  await addNode(page, 'gxam');
  await row(page, 'the boot-up of node 2', (one) => one.id === '702');
  await nmt(page, 'Start');
  await row(page, 'a PDO of node 2', (one) => one.id === '182');
  const nodes = page.getByRole('group', { name: 'Devices on the bus' });
  await nodes.getByRole('button', { name: /gxmm/ }).click();
  await becomes('the state of node 1', () => state(page), 'Pre-operational');
  await sdo(page, '1000');
  await row(page, 'an answer of node 1', (one) => one.id === '581');
  await addNode(page, 'gdmm');
  await row(page, 'the boot-up of node 3', (one) => one.id === '703');
  await addNode(page, 'gbam');
  await row(page, 'the boot-up of node 4', (one) => one.id === '704');
  await becomes('ways to add a node', () => page.getByRole('button', { name: 'Add a node' }).count(), 0);
  await becomes('the address', () => page.url(), /#device=gxmm&node=1&device=gxam&node=2&device=gdmm&node=3&device=gbam&node=4/);
  await page.locator('.device-button').click();
  await page.getByRole('button', { name: 'Remove from the bus' }).click();
  await becomes('nodes', () => nodes.getByRole('button', { name: /node \d/ }).count(), 3);
  await page.reload();
  await row(page, 'all boot-ups after loading', (one) => one.id === '703');
});

check('two nodes with one node ID destroy each other’s answers, until one of them cannot any more', {}, async (page) => {
  await page.getByRole('button', { name: 'Add a node' }).click();
  await page.getByRole('dialog').getByRole('spinbutton', { name: 'Node ID' }).fill('1');
  await page.getByText('both nodes will respond').waitFor();
  await page.getByRole('dialog').getByRole('button', { name: 'gxam' }).click();
  await becomes('boot-ups', async () => (await rows(page)).filter((one) => one.id === '701').length, 2);
  await sendRaw(page, '601#4000100000000000');
  const answers = async (isError) => (await rows(page)).filter((one) => one.id === '581' && (one.tag === 'ERR') === isError);
  await becomes('answers', async () => (await answers(false)).length, 2);
  await until('an error frame that says why', async () => (await answers(true)).some((one) => /same moment.*counter \d+/.test(one.words)));
});

check('the send line takes what a script says of the world', {}, async (page) => {
  await addNode(page, 'gxam');
  await sendRaw(page, 'emcy 4200h');
  await row(page, 'its EMCY', (one) => one.id === '082' && one.data.startsWith('00 42 09'));
  await sendRaw(page, 'set 1017h = 100');
  const beat = await row(page, 'its heartbeat', (one) => one.id === '702' && one.data === '7F');
  await sendRaw(page, 'set 6004h = 5');
  await becomes('why not', () => page.locator('.toasts').textContent(), /6004h Position value is computed by the device/);
  await sendRaw(page, 'power cycle 1s');
  await row(page, 'its boot-up', (one) => one.id === '702' && one.data === '00' && one.number > beat.number);
});

check('rotary and DIP switches act at the next start', {}, async (page) => {
  await part(page, 'Hardware');
  const id = page.getByRole('spinbutton', { name: 'Node ID' }).first();
  await id.fill('42');
  await id.press('Enter');
  await page.getByText('at the next start').waitFor();
  await page.getByRole('switch', { name: 'DIP 1' }).click();
  await cycle(page);
  await row(page, 'the boot-up of node 42', (one) => one.id === '72A');
  await becomes('its bit rate', () => page.getByLabel('Active bit rate').textContent(), '250 kbit/s');
  await becomes('what waits for the next start', () => page.getByText('at the next start').count(), 0);
});

check('another bit rate makes a stranger on the bus, and bus-off of who talks', {}, async (page) => {
  await addNode(page, 'gxam');
  await part(page, 'Hardware');
  const id = page.getByRole('spinbutton', { name: 'Node ID' }).first();
  await id.fill('2');
  await id.press('Enter');
  await page.getByRole('switch', { name: 'DIP 1' }).click();
  await cycle(page);
  await row(page, 'a destroyed boot-up, and bus-off', (one) => one.tag === 'ERR' && one.id === '702' && /another bit rate.*bus-off/.test(one.words));
  // Bus-off ends when the bus has been recessive for long enough.
  await becomes('the controller', () => page.locator('[data-controller=node]').textContent(), /error active/);
  await sdo(page, '1000');
  await note(page, /No response/);
  await page.getByRole('group', { name: 'Devices on the bus' }).getByRole('button', { name: /gxmm/ }).click();
  await sdo(page, '1000');
  await note(page, /1000h = /);
  // The page with a bit rate that no node has: what to do is said where it happens.
  const rate = page.getByRole('combobox', { name: 'Bit rate of this page' });
  await rate.selectOption('125');
  await sdo(page, '1000');
  const off = page.locator('od-console od-bus-off');
  await off.getByText('This page is bus-off').waitFor();
  await rate.selectOption('0');
  await off.getByRole('button', { name: 'Restart' }).click();
  await off.getByText('This page is bus-off').waitFor({ state: 'detached' });
  await sdo(page, '1000');
  await note(page, /1000h = /);
});

check('without its terminators the wire loses frames, alone on it nobody acknowledges', {}, async (page) => {
  await part(page, 'Hardware');
  await page.getByRole('button', { name: '0 × 120 Ω' }).click();
  await page.getByRole('combobox', { name: 'Speed' }).selectOption('100');
  await nmt(page, 'Start');
  await row(page, 'reflections', (one) => one.tag === 'ERR' && /terminator/.test(one.words));
  await page.getByRole('button', { name: '2 × 120 Ω' }).click();
  await page.locator('[data-controller=page]').getByRole('checkbox', { name: 'Plugged in' }).click();
  await row(page, 'no acknowledge', (one) => one.tag === 'ERR' && /acknowledged/.test(one.words));
  await becomes('the controller', () => page.locator('[data-controller=node]').textContent(), /error passive/);
});

check('a fault is reported on the bus and by the lamp', {}, async (page) => {
  await nmt(page, 'Start');
  await part(page, 'Hardware');
  await page.getByRole('button', { name: 'Sensor position' }).click();
  await row(page, 'an emergency', (one) => one.id === '081' && one.tag === 'EMCY');
  await part(page, 'Shaft');
  await becomes('the lamp', () => page.locator('.led-words').textContent(), /Red/);
});

check('the EEPROM shows what is not saved, and a save can be cut short', {}, async (page) => {
  await written(page, '6003', '1000');
  await part(page, 'EEPROM');
  await page.getByText('1 object would change at a power cycle').waitFor();
  const saved = () => page.getByRole('region', { name: 'Bytes of the EEPROM' }).textContent();
  const before = await until('its bytes', saved);
  await page.getByRole('spinbutton', { name: 'after bytes' }).fill('30');
  await page.getByRole('button', { name: 'Cut power during the next save' }).click();
  await sdo(page, '1010:01', '"save"');
  await becomes('the state', () => state(page), 'Off');
  await until('a half-written save', async () => (await saved()) !== before);
  await page.getByRole('switch', { name: 'Power' }).click();
  await becomes('boot-ups', async () => (await rows(page)).filter((one) => one.id === '701').length, 2);
  await sdo(page, '6003');
  await note(page, /6003h = 0/);
  await written(page, '6003', '1000');
  await written(page, '1010:01', '"save"');
  await page.getByText('All current values are saved').waitFor();
  await page.getByRole('button', { name: 'Power cycle' }).click();
  await becomes('boot-ups', async () => (await rows(page)).filter((one) => one.id === '701').length, 3);
  await sdo(page, '6003');
  await note(page, /6003h = 1\D?000/);
});

check('the shaft follows a profile', {}, async (page) => {
  await page.getByRole('combobox', { name: 'Motion' }).selectOption('Back and forth');
  await until('forward', async () => (await number(page, 'Turns')) >= 1);
  await becomes('and back', () => number(page, 'Turns'), 0);
  await page.getByRole('combobox', { name: 'Motion' }).selectOption('own');
  const own = page.getByRole('textbox', { name: 'Own profile' });
  await own.fill('60 x');
  await page.getByText('is not a speed and a time').waitFor();
  await own.fill('0 1, 600 1');
  await own.press('Enter');
  await until('the shaft to turn', async () => (await number(page, 'Turns')) > 3);
  await page.getByRole('combobox', { name: 'Motion' }).selectOption('Steady speed');
  await stays(page, 'the position', () => position(page), 300);
});

check('time steps by frames, forward and back', {}, async (page) => {
  await written(page, '1017', '1000');
  await nmt(page, 'Start');
  await stopTime(page);
  const count = await captured(page);
  const start = await clock(page);
  await page.getByRole('button', { name: 'Step to the next frame' }).click();
  const newest = await row(page, 'one frame more', (one) => one.number === count);
  await page.getByRole('button', { name: 'Step to the next frame' }).click();
  const later = await row(page, 'two frames more', (one) => one.number === count + 1);
  for (let left = 1; left >= 0; left--) {
    await page.getByRole('button', { name: 'Step back one frame' }).click();
    await becomes('frames', () => captured(page), count + left);
  }
  await until('no time before the stop', async () => (await clock(page)) >= start);
  for (const again of [newest, later]) {
    await page.getByRole('button', { name: 'Step to the next frame' }).click();
    const { time, id, data } = again;
    await row(page, 'the same frame again', (one) => one.time === time && one.id === id && one.data === data);
  }
});

check('a step back undoes what a person did', {}, async (page) => {
  await stopTime(page);
  await nmt(page, 'Start');
  await becomes('the state', () => state(page), 'Operational');
  await page.getByRole('button', { name: 'Step back one frame' }).click();
  await becomes('the state', () => state(page), 'Pre-operational');
  await becomes('frames', () => captured(page), 1);
});

check('one frame moves exactly one frame, request and answer apart; stepping back keeps PDO and state', {}, async (page) => {
  await nmt(page, 'Start');
  await row(page, 'a PDO1', (one) => one.id === '181');
  await stopTime(page);
  const pdo = () => page.locator('od-chain').textContent();
  const shown = await pdo();
  const count = await captured(page);
  await sendRaw(page, '601#40 00 10 00 00 00 00 00');
  await becomes('the request alone', () => captured(page), count + 1);
  const request = await row(page, 'the request', (one) => one.number === count);
  await page.getByRole('button', { name: 'Step to the next frame' }).click();
  await becomes('the next frame', () => captured(page), count + 2);
  const next = await row(page, 'the response', (one) => one.number === count + 1);
  // 116 bits at 50 kbit/s, after the processing time.
  assert.ok(next.time - request.time >= 0.0015, `${request.time} to ${next.time}`);
  await page.getByRole('button', { name: 'Step back one frame' }).click();
  await page.getByRole('button', { name: 'Step back one frame' }).click();
  await becomes('frames', () => captured(page), count);
  assert.equal(await pdo(), shown);
  assert.equal(await state(page), 'Operational');
});

check('three nodes that send too much fill the line to 100 %, and say so', {}, async (page) => {
  await addNode(page, 'gxam');
  await addNode(page, 'gdmm');
  for (const node of [1, 2, 3]) {
    await sendRaw(page, `60${node}#2B 00 18 05 01 00 00 00`);
    await row(page, `the confirmation of node ${node}`, (one) => one.id === `58${node}` && one.data.startsWith('60 00 18 05'));
  }
  await sendRaw(page, '000#01 00');
  await until('a full line', () => page.getByText('The line is full').isVisible());
  const load = await page.locator('.bus-status').textContent();
  assert.ok(Number(/Bus load (\d+)/.exec(load)[1]) <= 100, load);
  await until('a red bar', () => page.locator('.meter[data-full]').isVisible());
});

check('the DIP switches say when they act, and why they do not', {}, async (page) => {
  await part(page, 'Hardware');
  const words = page.locator('od-hardware');
  await becomes('a word about 0', () => words.textContent(), /rotary switches are at 0/);
  await page.getByRole('spinbutton', { name: 'Node ID' }).fill('7');
  await page.getByRole('spinbutton', { name: 'Node ID' }).press('Enter');
  await becomes('a word about the next start', () => words.textContent(), /reads its switches when it starts/);
  await until('a badge', () => page.getByRole('group', { name: 'Encoder views' }).locator('.count-badge').isVisible());
  await words.getByRole('button', { name: 'Reset node' }).click();
  await row(page, 'the boot-up of node 7', (one) => one.id === '707');
});
