// The editor of EDS files, the report of an opened file, and undoing a replacement.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { flawless } from './axe.mjs';
import { becomes, booted, nmt, sdo, sdoNote, state, until } from './bench.mjs';
import { checks } from './check.mjs';

const check = checks(booted);

/** Opens the editor with the selected device. */
async function edit(page) {
  await page.locator('.device-button').click();
  await page.getByRole('button', { name: /^Edit the EDS of/ }).click();
  await page.locator('.cm-line').first().waitFor();
}

/** Moves the cursor to the end of a key's line in a section. */
async function to(page, section, key) {
  await page.getByRole('button', { name: 'Outline' }).click();
  await page.getByRole('searchbox', { name: 'Search the sections' }).fill(section);
  await page.locator('.outline-row', { hasText: section }).first().click();
  const line = page.locator('.cm-activeLine');
  await becomes('the line', () => line.textContent(), /^\[/);
  while (!(await line.textContent()).startsWith(key)) await page.keyboard.press('ArrowDown');
  await page.keyboard.press('End');
}

const findings = (page) => page.locator('.editor-side .finding');
const note = (page) => page.locator('.editor-note').textContent();
const line = (page) => page.locator('.cm-activeLine').textContent();

/** Drops a file whose text or bytes are computed by an expression in the page. */
const drop = (page, name, content) =>
  page.evaluate(
    ([name, content]) => {
      const dataTransfer = new DataTransfer();
      dataTransfer.items.add(new File([eval(content)], name));
      document.body.dispatchEvent(new DragEvent('drop', { dataTransfer, bubbles: true, cancelable: true }));
    },
    [name, content],
  );

check('an edited device boots, a master’s view of it is beside it, and the device before comes back', async (page) => {
  await sdo(page, '6001', '4096');
  await becomes('the answer', () => sdoNote(page), /6001h written/);
  await nmt(page, 'Start');
  await edit(page);
  await to(page, '2800h', 'DefaultValue');
  await page.keyboard.type('x');
  await page.getByRole('button', { name: 'Findings' }).click();
  await becomes('the finding', () => findings(page).allTextContents().then(String), /E0412 2800h "TPDO1 repeat counter": DefaultValue 0x is not a valid UNSIGNED8/);
  await page.getByRole('button', { name: 'Run it' }).click();
  await becomes('why it cannot run', () => note(page), /Cannot run\. Line \d+: 2800h "TPDO1 repeat counter": DefaultValue/);
  await becomes('the line of it', () => line(page), 'DefaultValue=0x');
  await page.keyboard.press('End');
  await page.keyboard.press('Backspace');
  await page.keyboard.press('Backspace');
  await page.keyboard.type('5');
  await until('no findings', async () => (await findings(page).count()) === 0);
  await page.getByRole('button', { name: 'Run it' }).click();
  await becomes('what became of it', () => note(page), /Node 1 boots with this text\. Its EEPROM is that of a new device\./);
  await becomes('what a master notices', () => page.getByRole('list', { name: 'Differences for a master' }).textContent(), /2800h.*TPDO1 repeat counter: default 0 -> 5/);
  await page.getByRole('button', { name: 'Show the bench' }).click();
  await sdo(page, '2800');
  await becomes('the new default', () => sdoNote(page), /2800h = 5/);
  await becomes('its state', () => state(page), 'Pre-operational');
  await page.locator('.device-button').click();
  await page.getByRole('button', { name: 'Undo: back to gxmm' }).click();
  await becomes('the state before', () => state(page), 'Operational');
  await becomes('the device before', () => page.locator('.device-button strong').textContent(), 'gxmm');
  await sdo(page, '6001');
  await becomes('a value before', () => sdoNote(page), /6001h = 4.?096/);
});

check('hover, completion, jumps and fixes are those of the language server', async (page) => {
  await edit(page);
  await to(page, '1A00h:01', 'DefaultValue');
  await page.keyboard.press('F12');
  await becomes('the mapped object', () => line(page), '[6004]');
  await page.keyboard.press('Control+End');
  await page.keyboard.insertText('\n[2999]\n');
  await page.keyboard.type('AccessT');
  const list = page.locator('.cm-tooltip-autocomplete');
  // A key pressed at once is not for the list that has just opened, and ends the line.
  await list.getByRole('option').filter({ hasText: 'AccessType' }).first().click();
  await becomes('the key', () => line(page), /^AccessType/);
  await page.keyboard.press('Control+Home');
  await to(page, '2801h', 'AccessType');
  await page.keyboard.press('Backspace');
  await page.keyboard.type('/w');
  const wrong = page.locator('.cm-activeLine .od-error').first();
  await wrong.waitFor();
  await wrong.hover();
  await becomes('the rule', () => page.locator('.od-prose').textContent(), /W0424[^]*Source: CiA 306/);
  await page.getByRole('button', { name: 'Findings' }).click();
  await findings(page).filter({ hasText: 'W0424' }).getByRole('button').first().click();
  await page.locator('.fixes button', { hasText: 'Fix W0424: write AccessType=rw' }).click();
  await becomes('the fixed line', async () => (await page.locator('.cm-content').textContent()).includes('AccessType=r/w'), false);
});

check('the editor leaves Tab and Escape alone, keeps what was typed, and axe finds nothing', async (page) => {
  await edit(page);
  await to(page, '2801h', 'DefaultValue');
  await page.keyboard.type('z');
  await page.getByRole('button', { name: 'Findings' }).click();
  await findings(page).first().waitFor();
  await flawless(page, 'the editor');
  await page.locator('.cm-content').focus();
  await page.keyboard.press('Tab');
  await becomes('the focus behind the text', () => page.evaluate(() => document.activeElement.textContent), 'Findings');
  await page.keyboard.press('Shift+Tab');
  await page.keyboard.press('Escape');
  await page.getByRole('dialog', { name: /gxmm\.eds/ }).waitFor({ state: 'hidden' });
  // The typed text is still there.
  await edit(page);
  await becomes('the line', () => line(page), 'DefaultValue=0z');
  await page.keyboard.press('Escape');
  // Opening another file in between loses nothing.
  await drop(page, 'mixed.eds', "'[FileInfo]\\r\\nFileName=x.eds\\n[2000]\\nParameterName=Lamp\\n'");
  await page.getByRole('alert', { name: 'Findings in the file' }).getByRole('button', { name: 'Open in the editor' }).click();
  await becomes('a word about its line ends', () => note(page), /lines that end with CRLF and lines that end with LF[^]*saved with LF/);
  await page.keyboard.press('Escape');
  await edit(page);
  await becomes('a word about the changes', () => note(page), /Your changes to this text were restored/);
  await until('what was typed', async () => (await page.locator('.cm-line').allTextContents()).includes('[FileInfo]'));
  await page.getByRole('button', { name: 'Findings' }).click();
  await becomes('the finding', () => findings(page).allTextContents().then(String), /E0412 2801h/);
});

check('the text of the editor is saved as a file, with its changes', async (page) => {
  await edit(page);
  await to(page, '2800h', 'DefaultValue');
  await page.keyboard.type('7');
  const changed = await line(page);
  const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'Save as file' }).click()]);
  assert.equal(download.suggestedFilename(), 'gxmm.eds');
  const lines = (await readFile(await download.path(), 'latin1')).split(/\r?\n/);
  assert.ok(lines.slice(lines.indexOf('[2800]')).includes(changed), changed);
});

check('20,000 findings: errors first, by rule, all of them in reach, little of them in the page', async (page) => {
  const found = "'[FileInfo]\\nFileName=x.eds\\n[2000]\\nParameterName=Lamp\\nDataType=0x0005\\nAccessType=rw\\nDefaultValue=lots\\n' + Array.from({ length: 10000 }, (_, i) => `Mystery${i}=1\\nline ${i}\\n`).join('')";
  await drop(page, 'many.eds', found);
  const report = page.getByRole('alert', { name: 'Findings in the file' });
  await becomes('the count', () => report.locator('header').textContent(), /many\.eds cannot run\.[^]*5 errors, 10,\d{3} warnings, 10,\d{3} remarks/);
  await becomes('the first rule', () => report.locator('.rule').first().textContent(), /E0412/);
  await flawless(page, 'the report', 'od-report');
  const bottom = () => report.locator('.found').evaluate((list) => (list.scrollTop = list.scrollHeight));
  await bottom();
  await report.locator('.rule', { hasText: 'I0' }).locator('button[aria-expanded=false]').last().click();
  const last = async () => {
    await bottom();
    return (await report.locator('.finding').last().textContent()).replaceAll(/\s+/g, ' ');
  };
  await becomes('the last one', last, /^ ?20006:1.*Mystery9999/);
  assert.ok((await page.locator('.report *').count()) < 1500, 'few elements');
});

check('a file that is no EDS says what it is, and the bench stays', async (page) => {
  const report = page.getByRole('alert', { name: 'Findings in the file' });
  for (const [name, content, said] of [
    ['photo.eds', "Uint8Array.from('\\x89PNG\\r\\n\\x1a\\n\\0\\0', (c) => c.charCodeAt())", /photo\.eds is a picture \(PNG\), not an EDS file/],
    ['files.eds', "Uint8Array.from('PK\\x03\\x04\\0\\0', (c) => c.charCodeAt())", /files\.eds is a ZIP archive, not an EDS file of CANopen\. Unpack it/],
    ['none.eds', "''", /none\.eds is empty, not an EDS file/],
    ['notes.txt', "'Call the plumber.\\n'", /notes\.txt is a text without a section such as \[FileInfo\], not an EDS file/],
    ['data.eds', "'[{\"a\": [1]}]'", /data\.eds is a JSON file, not an EDS file/],
    ['adapter.eds', "'$ EZ-EDS\\n[File]\\n[Device]\\n  VendCode = 46;\\n'", /adapter\.eds is an EDS of EtherNet\/IP or DeviceNet \(ODVA\), not an EDS file of CANopen/],
  ]) {
    await drop(page, name, content);
    await becomes('what it is', () => report.textContent(), said);
  }
  await becomes('the device', () => page.locator('.device-button strong').textContent(), 'gxmm');
  await drop(page, 'trace.txt', "'(1.0) can0 701#00\\n(1.1) can0 181#0011\\n'");
  // The user is asked before a capture is replaced.
  await becomes('the offer', () => page.getByRole('region', { name: 'Offers' }).textContent(), /trace\.txt/);
});

check('an EDS is written into an empty file, and runs', async (page) => {
  await drop(page, 'new\u001b\u202e.eds', "''");
  const report = page.getByRole('alert', { name: 'Findings in the file' });
  await becomes('what it is', () => report.textContent(), /new\ufffd\ufffd\.eds is empty, not an EDS file of CANopen\. The editor says what a new one needs\./);
  await report.getByRole('button', { name: 'Open in the editor' }).click();
  await page.locator('.cm-content').focus();
  await becomes('what is missing', () => findings(page).allTextContents().then(String), /E0210/);
  const object = (index, name, type, access) => `[${index}]\nParameterName=${name}\nDataType=${type}\nAccessType=${access}\nDefaultValue=0\n`;
  const lists = '[MandatoryObjects]\nSupportedObjects=3\n1=0x1000\n2=0x1001\n3=0x1018\n[OptionalObjects]\nSupportedObjects=1\n1=0x1017\n';
  const identity = '[1018]\nParameterName=Identity\nObjectType=9\nSubNumber=2\n' + object('1018sub0', 'Highest sub-index', 5, 'const').replace('Value=0', 'Value=1') + object('1018sub1', 'Vendor-ID', 7, 'ro');
  await page.keyboard.insertText(lists + identity + object('1000', 'Device type', 7, 'ro') + object('1001', 'Error register', 5, 'ro') + object('1017', 'Producer heartbeat time', 6, 'rw'));
  await becomes('no error', () => page.locator('.editor-side').textContent(), /0 errors/);
  await page.getByRole('button', { name: 'Run it' }).click();
  await becomes('the device', () => note(page), /Node 1 boots with this text/);
  await page.getByRole('button', { name: 'Show the bench' }).click();
  await sdo(page, '1017');
  await becomes('an object of it', () => sdoNote(page), /1017h = 0/);
});

check('Enter after a complete word is a new line, also while words are offered', async (page) => {
  await edit(page);
  await to(page, '2800h', 'AccessType');
  const before = await line(page);
  for (let left = before.length - 'AccessType='.length; left > 0; left--) await page.keyboard.press('Backspace');
  const word = before.slice('AccessType='.length);
  await page.keyboard.type(word, { delay: 30 });
  // On a busy computer the list is first that of the letter before.
  await becomes('the offered word', async () => (await page.locator('.cm-tooltip-autocomplete [aria-selected=true] .cm-completionLabel').allTextContents()).join(), word);
  // For its first 75 ms a list ignores Enter, and Enter would be a new line in any case.
  await page.waitForTimeout(100);
  await page.keyboard.press('Enter');
  await becomes('the new line', () => line(page), '');
  await page.keyboard.press('ArrowUp');
  await becomes('the line above', () => line(page), before);
});
