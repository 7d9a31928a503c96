// A drive and an I/O module: their panel, its state chart, its inputs.
import assert from 'node:assert/strict';
import { flawless } from './axe.mjs';
import { becomes, row, sendRaw } from './bench.mjs';
import { checks } from './check.mjs';

const check = checks((page) => page.locator('.machine .pin, .drive-state').first().waitFor());

const active = (page) => page.locator('.drive-state[data-active] text').textContent();
const press = (page, name) => page.getByRole('button', { name, exact: true }).click();
const value = (page, name) => page.locator(`[data-value=${name}]`).textContent();
const pin = (page, name) => page.locator(`[data-pin="${name}"]`);

/** Leads the axis to "operation enabled". */
async function enable(page) {
  await becomes('the state', () => active(page), 'Switch on disabled');
  for (const [command, state] of [['Shutdown', 'Ready to switch on'], ['Switch on', 'Switched on'], ['Enable operation', 'Operation enabled']]) {
    await press(page, command);
    await becomes('the state', () => active(page), state);
  }
}

for (const [width, height] of [[1366, 768], [390, 844]]) {
  check(`an axis goes to its target, ${width} pixels wide`, { width, height, hash: '#device=drive&node=3' }, async (page) => {
    await enable(page);
    const mode = page.getByRole('combobox', { name: 'Mode of operation' });
    await mode.selectOption({ label: 'Profile position' });
    await page.getByRole('spinbutton', { name: 'Target' }).fill('-20000');
    await press(page, 'Go');
    await becomes('the position', () => value(page, 'position'), '-20\u2009000');
    await becomes('the target', () => value(page, 'target'), '-20\u2009000');
    await mode.selectOption({ label: 'Profile velocity' });
    // The drive has to confirm the mode (6061h); then the target is that of the speed.
    await becomes('the target', () => value(page, 'target'), '0');
    await page.getByRole('spinbutton', { name: 'Target' }).fill('5000');
    await press(page, 'Go');
    await becomes('the speed', () => value(page, 'velocity'), '5\u2009000');
    await press(page, 'Quick stop');
    await becomes('the state', () => active(page), 'Switch on disabled');
    await flawless(page, 'the panel', 'od-machine');
  });
}

check('safe torque off is a fault that a reset clears; the second axis is another one', { width: 1366, height: 768, hash: '#device=drive&node=3' }, async (page) => {
  await enable(page);
  await pin(page, 'sto1').click();
  await becomes('the state', () => active(page), 'Fault');
  await becomes('the error', () => page.locator('.machine .badge[data-tone=bad]').textContent(), 'Error 5441h');
  await becomes('the brake', () => pin(page, 'brake1').getAttribute('data-lit'), 'false');
  await press(page, 'Axis 2');
  await becomes('the state', () => active(page), 'Switch on disabled');
  await press(page, 'Shutdown');
  await becomes('the state', () => active(page), 'Ready to switch on');
  await row(page, 'the command of axis 2', (one) => one.data.startsWith('2B 40 68 00 06'));
  await press(page, 'Axis 1');
  await pin(page, 'sto1').click();
  await becomes('the switch', () => pin(page, 'sto1').getAttribute('aria-checked'), 'false');
  await press(page, 'Fault reset');
  await becomes('the state', () => active(page), 'Switch on disabled');
});

for (const [width, height] of [[1366, 768], [390, 844]]) {
  check(`inputs are clicked and outputs are lamps, ${width} pixels wide`, { width, height, hash: '#device=io&node=4' }, async (page) => {
    assert.equal(await page.locator('.machine button.pin').count(), 17);
    await pin(page, 'in3').click();
    await becomes('the input', () => pin(page, 'in3').getAttribute('aria-checked'), 'true');
    const level = page.getByRole('spinbutton', { name: 'ain2' });
    await level.fill('-1234');
    await level.press('Enter');
    await becomes('the level', () => level.inputValue(), '-1234');
    const tab = async (name) => width < 1024 && page.getByRole('tab', { name }).click();
    await tab('Bus');
    // Operational; outputs 2 and 9.
    for (const frame of ['000#0104', '604#2F00620102000000', '604#2F00620201000000']) await sendRaw(page, frame);
    await tab('I/O module');
    for (const [name, lit] of [['out1', 'false'], ['out2', 'true'], ['out9', 'true']]) await becomes(name, () => pin(page, name).getAttribute('data-lit'), lit);
    await flawless(page, 'the panel', 'od-machine');
  });
}
