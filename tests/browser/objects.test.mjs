// The object dictionary: read by name over the bus, and live values beside it.
import assert from 'node:assert/strict';
import { becomes, booted, captured, row, sdo, sdoNote, until } from './bench.mjs';
import { checks } from './check.mjs';

const check = checks(booted);

const note = (page, pattern) => becomes('the note under the SDO line', () => sdoNote(page), pattern);

check('reads and writes by index', async (page) => {
  await sdo(page, '1017', '500');
  await note(page, /1017h written/);
  await sdo(page, '1017');
  await note(page, /1017h = 500/);
  await row(page, 'a heartbeat', (one) => one.id === '701' && one.data === '7F');
});

check('offers objects by name', async (page) => {
  const box = page.getByRole('combobox', { name: 'Object', exact: true });
  await box.fill('heartbeat');
  const options = page.getByRole('listbox', { name: 'Objects', exact: true }).getByRole('option');
  await until('offers', async () => (await options.count()) > 0);
  await box.press('ArrowDown');
  await box.press('Enter');
  await becomes('the object', () => box.inputValue(), /^10\d\dh/);
  await page.getByRole('button', { name: 'Read', exact: true }).click();
  await note(page, /= /);
});

check('explains an abort in words', async (page) => {
  await sdo(page, '1000', '1');
  await note(page, /06010002.*read[- ]only|read[- ]only.*06010002/i);
  await row(page, 'the abort', (one) => one.id === '581' && one.data === '80 00 10 00 02 00 01 06');
  await sdo(page, '5555');
  await note(page, /06020000/);
});

check('checks width and limits before it sends', async (page) => {
  const before = await captured(page);
  await page.getByRole('combobox', { name: 'Object', exact: true }).fill('2101');
  await page.getByRole('textbox', { name: 'Value', exact: true }).fill('300');
  await note(page, /does not fit UNSIGNED8/);
  await until('nothing to write', () => page.getByRole('button', { name: 'Write', exact: true }).isDisabled());
  await page.getByRole('textbox', { name: 'Value', exact: true }).fill('twelve');
  await note(page, /not a whole number/);
  assert.equal(await captured(page), before);
});

check('a text of four characters saves the parameters', async (page) => {
  await sdo(page, '1010:01', '"save"');
  await note(page, /1010h:01 written/);
  await row(page, 'the signature', (one) => one.id === '601' && one.data === '23 10 10 01 73 61 76 65');
});

check('shows live values without a frame on the bus', async (page) => {
  const list = page.getByRole('listbox', { name: 'Objects with their live values' });
  const before = await captured(page);
  await page.getByRole('searchbox', { name: 'Search objects' }).fill('6004');
  const position = list.getByRole('option').filter({ hasText: '6004h' });
  const value = position.locator('.value');
  await until('a value', async () => (await value.textContent()) !== '');
  const start = await value.textContent();
  await page.getByRole('slider', { name: 'Shaft' }).press('PageUp');
  await until('another value', async () => (await value.textContent()) !== start);
  assert.equal(await captured(page), before);
});

check('marks what was changed and shows the details', async (page) => {
  await page.getByRole('searchbox', { name: 'Search objects' }).fill('2300');
  const data = page.getByRole('listbox', { name: 'Objects with their live values' }).getByRole('option').filter({ hasText: ':01' });
  await becomes('the value', () => data.locator('.value').textContent(), '0');
  await becomes('no mark', () => data.getAttribute('data-changed'), null);
  await data.click();
  await becomes('the object', () => page.getByRole('combobox', { name: 'Object', exact: true }).inputValue(), /^2300h:01/);
  await becomes('its type', () => page.locator('od-object-detail').textContent(), /UNSIGNED16/);
  await page.getByRole('textbox', { name: 'Value', exact: true }).fill('1234h');
  await page.getByRole('button', { name: 'Write', exact: true }).click();
  await note(page, /2300h:01 written/);
  await until('the mark', async () => (await data.getAttribute('data-changed')) !== null);
});
