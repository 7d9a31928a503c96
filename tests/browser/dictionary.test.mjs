// The object dictionary: marks, writing, the frames of an object, the mapping of PDOs, a DCF.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { becomes, booted, captured, file, nmt, row, rows, sdo, sdoNote, until } from './bench.mjs';
import { checks } from './check.mjs';

const check = checks(async (page) => {
  if (page.viewportSize().width < 1024) await page.getByRole('tab', { name: 'Bus' }).click();
  await booted(page);
});

const note = (page, pattern) => becomes('the note under the SDO line', () => sdoNote(page), pattern);
const search = (page, text) => page.getByRole('searchbox', { name: 'Search objects' }).fill(text);
const object = (page, text) => page.getByRole('listbox', { name: 'Objects with their live values' }).getByRole('option').filter({ hasText: text });
const detail = (page) => page.locator('od-object-detail');
const detailNote = (page, pattern) => becomes('the note under the object', () => page.locator('#detail-note').textContent(), pattern);
const shown = (page) => page.getByRole('option').filter({ visible: true });
const typed = (page) => page.getByRole('textbox', { name: 'New value' });

check('an object is written where it is shown; its range is checked, an abort explained', async (page) => {
  await search(page, '6001');
  await object(page, '6001h').click();
  await becomes('the range', () => detail(page).textContent(), /1 … 8.?192/);
  await typed(page).fill('9000');
  await becomes('a word about the range', () => detail(page).textContent(), /outside/);
  await typed(page).press('Enter');
  await detailNote(page, /0609003[01]/);
  await typed(page).fill('1000h');
  await typed(page).press('Enter');
  await detailNote(page, /6001h written/);
  await becomes('the value', () => object(page, '6001h').locator('.value').textContent(), /4.?096/);
  await row(page, 'the download', (one) => one.id === '601' && one.data === '23 01 60 00 00 10 00 00');
});

check('what is changed and what is saved is marked, and can be listed', async (page) => {
  await search(page, '6001');
  const mark = object(page, '6001h').locator('.mark');
  await becomes('no mark', () => mark.textContent(), '');
  await sdo(page, '6001', '1000');
  await becomes('changed and not saved', () => mark.textContent(), 'RAM');
  await object(page, '6001h').click();
  await becomes('both values', () => detail(page).textContent(), /Saved\s*8.?192/);
  await sdo(page, '1010:01', '"save"');
  await note(page, /1010h:01 written/);
  await becomes('changed and saved', () => mark.textContent(), 'EE');
  await sdo(page, '6001', '8192');
  // The value is the default again, but another one is saved.
  await becomes('not saved', () => mark.textContent(), 'RAM');
  await search(page, '');
  await page.getByRole('radio', { name: 'Not saved' }).check();
  await until('only that', async () => /^[^]*6001h/.test((await shown(page).allTextContents()).join()) && (await shown(page).count()) === 1);
  await sdo(page, '1017', '250');
  await becomes('two of them', () => shown(page).count(), 2);
  await page.getByRole('radio', { name: 'All' }).check();
});

check('from an object to its frames', async (page) => {
  await nmt(page, 'Start');
  await sdo(page, '6001');
  await sdo(page, '6004');
  await note(page, /6004h =/);
  await search(page, '6004');
  await object(page, '6004h').click();
  await page.getByRole('button', { name: 'Its frames' }).click();
  // SDO transfers about it, and the PDOs that contain it.
  await until('only its frames', async () => {
    const list = await rows(page);
    return list.length > 0 && list.every((one) => ['601', '581', '181', '281'].includes(one.id) && !/ 01 60 00/.test(one.data));
  });
  await becomes('the filter', () => page.getByRole('searchbox', { name: 'Filter frames' }).inputValue(), /6004.*181|181.*6004/);
});

check('the mapping editor shows the frames, sends them, and the PDO changes', { hash: '#device=eam_mt&node=1' }, async (page) => {
  await page.getByRole('button', { name: 'PDO mapping' }).click();
  const dialog = page.getByRole('dialog', { name: 'PDO mapping' });
  const steps = dialog.locator('.mapping-steps li');
  await becomes('steps', () => steps.count(), 3);
  await becomes('their frames', () => dialog.locator('.mapping-steps code span').allTextContents(), ['2F 00 1A 00 00 00 00 00', '23 00 1A 01 20 00 04 60', '2F 00 1A 00 01 00 00 00']);
  const before = await captured(page);
  await dialog.getByRole('combobox', { name: 'Add an object' }).selectOption({ label: (await dialog.getByRole('combobox', { name: 'Add an object' }).locator('option').filter({ hasText: /^6030h/ }).first().textContent()).trim() });
  await becomes('steps', () => steps.count(), 4);
  await becomes('words', () => steps.nth(2).textContent(), /1A00h:02/);
  await dialog.getByRole('button', { name: /^Move up/ }).nth(1).click();
  assert.equal(await captured(page), before, 'nothing is sent before it is said');
  await dialog.getByRole('button', { name: 'Send 4 frames' }).click();
  await becomes('steps that are done', () => steps.filter({ hasText: '✓' }).count(), 4);
  await page.keyboard.press('Escape');
  await nmt(page, 'Start');
  await row(page, 'a PDO1 of eight bytes', (one) => one.id === '181' && one.data.split(' ').length === 8 && /position/i.test(one.words));
});

check('a mapping that does not fit is refused in words, at its step', { hash: '#device=eam_mt&node=1' }, async (page) => {
  await page.getByRole('button', { name: 'PDO mapping' }).click();
  const dialog = page.getByRole('dialog', { name: 'PDO mapping' });
  const add = dialog.getByRole('combobox', { name: 'Add an object' });
  for (let i = 0; i < 2; i++) {
    await becomes('entries', () => dialog.locator('.mapping-entries li').count(), 1 + i);
    const option = add.locator('option').filter({ hasText: /^6004h/ });
    await add.selectOption({ value: await option.getAttribute('value') });
  }
  await becomes('the sum', () => dialog.textContent(), /96 of 64 bits/);
  await dialog.getByRole('button', { name: /^Send/ }).click();
  await becomes('an abort', () => dialog.locator('.mapping-steps').textContent(), /0604004[12]/);
  await becomes('steps that failed', () => dialog.locator('.mapping-steps li[data-tone=error]').count(), 1);
  // Disabling the PDO during the change needs two more frames.
  await dialog.getByRole('checkbox', { name: /Disable the PDO/ }).check();
  await becomes('the frames', async () => (await dialog.locator('.mapping-steps code span').allTextContents()).join(), /^23 00 18 01 81 01 00 [C8]0,.*,23 00 18 01 81 01 00 [04]0$/);
});

check('a fixed mapping says so, and the device refuses it', async (page) => {
  await page.getByRole('button', { name: 'PDO mapping' }).click();
  const dialog = page.getByRole('dialog', { name: 'PDO mapping' });
  await until('a word about it', () => dialog.getByText('mapping of this device is fixed').isVisible());
  await dialog.getByRole('button', { name: /^Send/ }).click();
  await becomes('the abort', () => dialog.locator('.mapping-steps').textContent(), /06010002/);
});

check('the state as a DCF, of ours and of a dropped EDS', async (page) => {
  await sdo(page, '6001', '2048');
  await note(page, /6001h written/);
  const save = async () => {
    const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'Save as DCF' }).click()]);
    return { name: download.suggestedFilename(), text: await readFile(await download.path(), 'latin1') };
  };
  const first = await save();
  assert.equal(first.name, 'gxmm-node1.dcf');
  assert.match(first.text, /NodeID=1\n/);
  assert.match(first.text, /\[6001\][^[]*ParameterValue=0x800\n/);
  // The DCF is opened again with another value: the rest of the file is unchanged.
  const changed = file('changed.dcf', `; a comment\n${first.text.replace('[6001]', '[Vendor]\nKey=kept\n\n[6001]')}`);
  await page.locator('.device-button').click();
  await page.getByLabel('EDS or DCF file').setInputFiles(changed);
  await until('the device of the file', async () => /node 1/.test(await page.locator('.topbar').textContent()) && !(await page.getByRole('dialog').isVisible()));
  await search(page, '6001');
  await becomes('its value', () => object(page, '6001h').locator('.value').textContent(), /2.?048/);
  await sdo(page, '1017', '500');
  await note(page, /1017h written/);
  const second = await save();
  assert.match(second.text, /\[6001\][^[]*ParameterValue=0x800\n/);
  assert.match(second.text, /\[1017\][^[]*ParameterValue=500\n/);
  assert.match(second.text, /\[Vendor\]\nKey=kept/);
});

check('on a phone, too', { width: 390, height: 844 }, async (page) => {
  await page.getByRole('tab', { name: 'Objects' }).click();
  await search(page, '6001');
  await object(page, '6001h').click();
  await typed(page).fill('4096');
  await typed(page).press('Enter');
  await detailNote(page, /6001h written/);
  await page.getByRole('button', { name: 'PDO mapping' }).click();
  await until('the dialog on the screen', async () => {
    const box = await page.getByRole('dialog', { name: 'PDO mapping' }).boundingBox();
    return box && box.x >= 0 && box.x + box.width <= 390;
  });
  await until('no sideways scrolling', () => page.evaluate(() => document.documentElement.scrollWidth <= 390));
});
