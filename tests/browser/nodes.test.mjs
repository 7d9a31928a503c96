// The bench: several nodes, their switches, faults, EEPROMs and shafts, the wire, and time.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { launch, open } from './harness.mjs';
import { booted, captured, nmt, number, position, row, rows, sdo, sdoNote, sendRaw, state, until } from './bench.mjs';

let browser;
before(async () => (browser = await launch()));
after(() => browser?.close());

function check(name, options, body) {
  test(name, async () => {
    const { page, faults, close } = await open(browser, options);
    try {
      await booted(page);
      await body(page);
      assert.deepEqual(faults, [], 'the page complained');
    } finally {
      await close();
    }
  });
}

const part = (page, name) => page.getByRole('group', { name: 'Encoder views' }).getByRole('button', { name }).click();
const written = (page, object, value) => sdo(page, object, value).then(() => until(`${object} written`, async () => /written/.test(await sdoNote(page))));
const cycle = async (page) => {
  await page.getByRole('switch', { name: 'Power' }).click();
  await until('Off', async () => (await state(page)) === 'Off');
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
  await until('node 1 in the panels', async () => (await state(page)) === 'Pre-operational');
  await sdo(page, '1000');
  await row(page, 'an answer of node 1', (one) => one.id === '581');
  await addNode(page, 'gdmm');
  await addNode(page, 'gbam');
  await row(page, 'the boot-up of node 4', (one) => one.id === '704');
  assert.equal(await page.getByRole('button', { name: 'Add a node' }).count(), 0);
  assert.match(await page.evaluate(() => location.hash), /device=gxmm&node=1&device=gxam&node=2&device=gdmm&node=3&device=gbam&node=4/);
  await page.locator('.device-button').click();
  await page.getByRole('button', { name: 'Take it off the bus' }).click();
  await until('three nodes', async () => (await nodes.getByRole('button', { name: /node \d/ }).count()) === 3);
  await page.reload();
  await row(page, 'all boot-ups after loading', (one) => one.id === '703');
});

check('two nodes with one node ID both answer', {}, async (page) => {
  await page.getByRole('button', { name: 'Add a node' }).click();
  await page.getByRole('dialog').getByRole('spinbutton', { name: 'Node ID' }).fill('1');
  await page.getByText('both will answer').waitFor();
  await page.getByRole('dialog').getByRole('button', { name: 'gxam' }).click();
  await until('the second boot-up', async () => (await rows(page)).filter((one) => one.id === '701').length === 2);
  await sendRaw(page, '601#4000100000000000');
  await until('two answers', async () => (await rows(page)).filter((one) => one.id === '581').length === 2);
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
  await until('its bit rate', async () => (await page.getByLabel('Active bit rate').textContent()) === '250 kbit/s');
  assert.equal(await page.getByText('at the next start').count(), 0);
});

check('another bit rate makes a stranger on the bus, and bus-off of who talks', {}, async (page) => {
  await addNode(page, 'gxam');
  await part(page, 'Hardware');
  const id = page.getByRole('spinbutton', { name: 'Node ID' }).first();
  await id.fill('2');
  await id.press('Enter');
  await page.getByRole('switch', { name: 'DIP 1' }).click();
  await cycle(page);
  await row(page, 'a destroyed boot-up', (one) => one.tag === 'ERR' && one.id === '702' && /another bit rate/.test(one.words));
  await until('bus-off', async () => /bus-off/.test(await page.locator('[data-controller=node]').textContent()));
  await sdo(page, '1000');
  await until('no answer', async () => /No answer/.test(await sdoNote(page)));
  await page.getByRole('group', { name: 'Devices on the bus' }).getByRole('button', { name: /gxmm/ }).click();
  await sdo(page, '1000');
  await until('the others go on', async () => /1000h = /.test(await sdoNote(page)));
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
  await until('error passive', async () => /error passive/.test(await page.locator('[data-controller=node]').textContent()));
});

check('what breaks is told on the bus and by the lamp', {}, async (page) => {
  await nmt(page, 'Start');
  await part(page, 'Hardware');
  await page.getByRole('button', { name: 'Sensor position' }).click();
  await row(page, 'an emergency', (one) => one.id === '081' && one.tag === 'EMCY');
  await part(page, 'Shaft');
  await until('the lamp', async () => /Red/.test(await page.locator('.led-words').textContent()));
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
  await until('Off', async () => (await state(page)) === 'Off');
  await until('a half-written save', async () => (await saved()) !== before);
  await page.getByRole('switch', { name: 'Power' }).click();
  await sdo(page, '6003');
  await until('the old value', async () => /6003h = 0/.test(await sdoNote(page)));
  await written(page, '6003', '1000');
  await written(page, '1010:01', '"save"');
  await page.getByText('Everything is saved').waitFor();
  await page.getByRole('button', { name: 'Power cycle' }).click();
  await until('another boot-up', async () => (await rows(page)).filter((one) => one.id === '701').length === 3);
  await sdo(page, '6003');
  await until('the saved value', async () => /6003h = 1\D?000/.test(await sdoNote(page)));
});

check('the shaft follows a profile', {}, async (page) => {
  await page.getByRole('combobox', { name: 'Motion' }).selectOption('Back and forth');
  await until('forward', async () => (await number(page, 'Turns')) >= 1);
  await until('and back', async () => (await number(page, 'Turns')) === 0, { within: 8000 });
  await page.getByRole('combobox', { name: 'Motion' }).selectOption('own');
  const own = page.getByRole('textbox', { name: 'Own profile' });
  await own.fill('60 x');
  await page.getByText('is not a speed and a time').waitFor();
  await own.fill('0 1, 600 1');
  await own.press('Enter');
  await until('the shaft to turn', async () => (await number(page, 'Turns')) > 3, { within: 8000 });
  await page.getByRole('combobox', { name: 'Motion' }).selectOption('Steady speed');
  await page.waitForTimeout(200);
  const still = await position(page);
  await page.waitForTimeout(300);
  assert.equal(await position(page), still);
});

check('time steps by frames, forward and back', {}, async (page) => {
  await written(page, '1017', '1000');
  await nmt(page, 'Start');
  await page.getByRole('button', { name: 'Stop time' }).click();
  await page.waitForTimeout(150);
  const count = await captured(page);
  const clock = () => page.getByRole('timer').textContent();
  const start = await clock();
  await page.getByRole('button', { name: 'Step to the next frame' }).click();
  await until('one frame more', async () => (await captured(page)) === count + 1);
  const newest = (await rows(page)).at(-1);
  await page.getByRole('button', { name: 'Step to the next frame' }).click();
  await until('two frames more', async () => (await captured(page)) === count + 2);
  const later = (await rows(page)).at(-1);
  for (let left = 1; left >= 0; left--) {
    await page.getByRole('button', { name: 'Step back one frame' }).click();
    await until('a frame less', async () => (await captured(page)) === count + left);
  }
  assert.ok((await clock()) >= start);
  for (const again of [newest, later]) {
    await page.getByRole('button', { name: 'Step to the next frame' }).click();
    const { time, id, data } = await row(page, 'the same frame again', (one) => one.time === again.time);
    assert.deepEqual({ time, id, data }, { time: again.time, id: again.id, data: again.data });
  }
});

check('a step back undoes what a person did', {}, async (page) => {
  await page.getByRole('button', { name: 'Stop time' }).click();
  await nmt(page, 'Start');
  await until('Operational', async () => (await state(page)) === 'Operational');
  await page.getByRole('button', { name: 'Step back one frame' }).click();
  await until('Pre-operational', async () => (await state(page)) === 'Pre-operational');
  assert.equal(await captured(page), 1);
});
