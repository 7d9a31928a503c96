// The frame console: filters, views, folds, search, marks, the send list, logs.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { becomes, booted, captured, file, framesOf, nmt, row, rows, sdo, sdoNote, sendRaw, stays, until } from './bench.mjs';
import { checks } from './check.mjs';

const check = checks(booted);

const filter = (page, text) => page.getByRole('searchbox', { name: 'Filter frames' }).fill(text);
const ids = async (page) => [...new Set((await rows(page)).map((one) => one.id))].sort().join(' ');

async function traffic(page) {
  await sdo(page, '1017', '100');
  await row(page, 'a heartbeat', (one) => one.id === '701' && one.data === '7F');
  await nmt(page, 'Start');
  await row(page, 'a PDO', (one) => one.id === '181');
}

check('the filter shows what passes, by service, node, identifier, object and word', {}, async (page) => {
  await traffic(page);
  for (const [text, expected] of [
    ['sdo', '581 601'],
    ['node:1 !sdo !hb nmt', '000'],
    ['180:780', '181'],
    ['1017', '581 601'],
    ['position', '181'],
    ['"heartbeat time" rx', '581'],
    ['nmt or pdo1', '000 181'],
  ]) {
    await filter(page, text);
    await becomes(`what passes “${text}”`, () => ids(page), expected);
  }
  await page.getByRole('button', { name: 'Clear' }).click();
  // The last filter lets NMT frames pass, too; none were sent since.
  await becomes('what passes after Clear', () => ids(page), '181');
  await filter(page, '');
  await row(page, 'all frames', (one) => one.id === '701');
});

check('a filter that cannot be read says so as it is typed', {}, async (page) => {
  const box = page.getByRole('searchbox', { name: 'Filter frames' });
  for (const [text, error] of [['node:', /missing/], ['node:200', /1 to 127/], ['nod:5', /not a field/], ['(sdo', /not closed/]]) {
    await box.fill(text);
    await becomes(`the note under “${text}”`, () => page.locator('#filter-note').textContent(), error);
    await becomes('aria-invalid', () => box.getAttribute('aria-invalid'), 'true');
  }
  await box.fill('hb');
  await until('no error', async () => (await page.locator('#filter-note').count()) === 0);
});

check('a filter takes lists and says how many frames pass; these can be saved alone', {}, async (page) => {
  await traffic(page);
  await filter(page, '701h,000');
  // The list stays at its beginning, whatever arrives.
  await page.locator('.frames').press('Home');
  await until('frames that pass', async () => /^\d+ of \d+ pass$/.test(await page.locator('.passing').textContent()));
  await becomes('what passes', () => ids(page), '000 701');
  const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name: 'Save these' }).click()]);
  const lines = (await readFile(await download.path(), 'utf8')).trim().split('\n');
  assert.ok(lines.length >= 2 && lines.every((line) => / (701|000)#/.test(line)), lines.join('\n'));
  await filter(page, '18FF50E5x');
  await becomes('the note', () => page.locator('#filter-note').textContent(), /neither a CAN-ID/);
});

const TEXT_LOG = ` (1.000000)  can0  705   [1]  00\n (1.100000)  can0  20000004   [8]  00 04 00 00 00 00 00 00   ERRORFRAME\n${Array.from({ length: 300 }, (_, i) => ` (${(1.2 + i / 100).toFixed(6)})  can0  185   [4]  0${i % 10} 00 00 00`).join('\n')}\n`;

check('a candump log called .txt is a log: it opens at its beginning, with its error frames, and is plotted from the log', {}, async (page) => {
  await page.getByLabel('Open log').setInputFiles(file('machine.txt', TEXT_LOG));
  const replace = page.getByRole('button', { name: 'Replace the capture' });
  await replace.click();
  await becomes('the first row', async () => (await rows(page))[0]?.id, '705');
  await row(page, 'the error frame', (one) => one.tag === 'ERR' && one.words === 'Error frame');
  assert.equal(await page.getByText('is not an EDS').count(), 0);
  await page.getByRole('button', { name: 'Plot' }).click();
  await page.locator('od-plot select').first().waitFor();
  await becomes('values of the live bench', () => page.locator('od-plot optgroup[label^="From the simulation"]').count(), 0);
});

check('a negative value for an unsigned object is refused', {}, async (page) => {
  await page.locator('#sdo-object').fill('1017');
  await page.getByRole('textbox', { name: 'Value', exact: true }).fill('-1');
  await becomes('the note', () => sdoNote(page), /-1 does not fit UNSIGNED16/);
});

check('one row for each identifier, and back to order without loss', {}, async (page) => {
  await traffic(page);
  await page.getByRole('button', { name: 'By CAN-ID' }).click();
  const table = page.getByRole('region', { name: 'By CAN-ID' });
  const line = table.getByRole('row').filter({ hasText: '701' });
  await becomes('the rhythm', () => line.textContent(), /100\.0 ms/);
  const count = async () => Number((await line.getByRole('cell').nth(2).textContent()).replace(/\D/g, ''));
  const first = await count();
  await until('more heartbeats', async () => (await count()) > first + 3);
  await page.getByRole('button', { name: 'In order' }).click();
  await page.locator('.frames').press('Home');
  await until('all frames', async () => (await captured(page)) > 10);
  await filter(page, 'sdo');
  await row(page, 'what came before', (one) => one.id === '601');
});

check('changed bytes are highlighted', {}, async (page) => {
  await sendRaw(page, '181#01 02 03');
  await sendRaw(page, '181#01 FF 03');
  const changed = page.locator('.frame', { hasText: '01 FF 03' }).locator('mark');
  await becomes('what is marked', () => changed.allTextContents(), ['FF']);
});

check('the second time column shows delta or cycle', {}, async (page) => {
  await traffic(page);
  await page.getByRole('button', { name: 'Delta' }).click();
  await becomes('the cycle', () => framesOf(page, '701').last().locator('.delta').textContent(), '+100.0 ms');
});

const LONG = `[FileInfo]\nFileName=long.eds\n[DeviceInfo]\nProductName=Long\n[MandatoryObjects]\nSupportedObjects=3\n1=0x1000\n2=0x1001\n3=0x1018\n[ManufacturerObjects]\nSupportedObjects=1\n1=0x2001\n[1000]\nParameterName=Device type\nObjectType=0x7\nDataType=0x0007\nAccessType=ro\nDefaultValue=0x191\nPDOMapping=0\n[1001]\nParameterName=Error register\nObjectType=0x7\nDataType=0x0005\nAccessType=ro\nDefaultValue=0\nPDOMapping=0\n[1018]\nParameterName=Identity\nObjectType=0x9\nSubNumber=2\n[1018sub0]\nParameterName=Number\nObjectType=0x7\nDataType=0x0005\nAccessType=const\nDefaultValue=1\nPDOMapping=0\n[1018sub1]\nParameterName=Vendor\nObjectType=0x7\nDataType=0x0007\nAccessType=ro\nDefaultValue=0\nPDOMapping=0\n[2001]\nParameterName=Label\nObjectType=0x7\nDataType=0x0009\nAccessType=rw\nDefaultValue=Pump room, second floor\nPDOMapping=0\n`;

async function drop(page, name, bytes) {
  const transfer = await page.evaluateHandle(
    ([name, bytes]) => {
      const transfer = new DataTransfer();
      transfer.items.add(new File([typeof bytes === 'string' ? bytes : Uint8Array.from(bytes)], name));
      return transfer;
    },
    [name, typeof bytes === 'string' ? bytes : [...bytes]],
  );
  await page.dispatchEvent('body', 'drop', { dataTransfer: transfer });
}

check('a transfer of many frames is one row, and opens', {}, async (page) => {
  await drop(page, 'long.eds', LONG);
  await becomes('the device', () => page.locator('.device-button').textContent(), /Long/);
  // The list has only visible rows, and the report of the file is above it.
  await page.getByRole('button', { name: 'Close the report' }).click();
  await sdo(page, 'Label');
  await row(page, 'the folded transfer', (one) => /Read 2001h Label = “Pump room, second floor”/.test(one.words) && /10 frames, 23 bytes/.test(one.data));
  await becomes('rows of SDO', async () => (await rows(page)).filter((one) => one.tag === 'SDO').length, 1);
  await page.locator('.frame', { hasText: 'Pump room' }).click();
  await becomes('its frames', () => page.locator('.fold div').count(), 10);
  await page.getByRole('button', { name: 'Fold SDO transfers' }).click();
  await becomes('a row for each', async () => (await rows(page)).filter((one) => one.tag === 'SDO').length, 10);
});

check('the chosen frame links bytes, fields and objects', {}, async (page) => {
  await nmt(page, 'Start');
  await row(page, 'a PDO', (one) => one.id === '181');
  await framesOf(page, '181').first().click();
  const detail = page.locator('.frame-detail');
  await detail.getByRole('button', { name: 'Position value' }).click();
  await becomes('the object', () => page.locator('od-object-detail').textContent(), /6004h/);
  await detail.locator('.byte').nth(2).hover();
  await becomes('its bytes', () => detail.locator('.byte[data-lit=true]').count(), 4);
  const before = await captured(page);
  await detail.getByRole('button', { name: 'Send again' }).click();
  await until('the frame again', async () => (await captured(page)) > before && (await rows(page)).some((one) => one.id === '181' && one.dir === 'Tx'));
});

check('finding goes from frame to frame, marks hold them', {}, async (page) => {
  await traffic(page);
  await page.locator('.frames').focus();
  await page.keyboard.press('/');
  const box = page.getByRole('textbox', { name: 'Find' });
  await box.fill('nmt');
  await box.press('Enter');
  const detail = page.locator('.frame-detail');
  await becomes('the NMT command', () => detail.textContent(), /Start node 1/);
  await page.locator('.frames').focus();
  await page.keyboard.press('b');
  await becomes('marked frames', () => page.locator('.frame[data-marked]').count(), 1);
  await page.locator('.frames').press('Escape');
  await box.fill('1017');
  await box.press('Enter');
  await becomes('the write', () => detail.textContent(), /1017h/);
  await page.getByRole('button', { name: 'Next marked frame' }).click();
  await becomes('the NMT command again', () => detail.textContent(), /Start node 1/);
  await box.fill('nosuchword');
  await box.press('Enter');
  await page.getByText('No frame passes.').waitFor();
});

check('the send list sends by click and in a rhythm, and is kept', {}, async (page) => {
  await page.getByText('Send list', { exact: true }).click();
  await page.getByRole('button', { name: 'Add a row' }).click();
  const what = page.getByRole('textbox', { name: 'What to send' });
  await what.fill('read 6004');
  await what.press('Tab');
  await page.locator('.send-list').getByRole('button', { name: 'Send', exact: true }).click();
  await row(page, 'the answer', (one) => one.id === '581' && one.data.startsWith('43 04 60 00'));
  await page.getByRole('spinbutton', { name: 'Cycle in milliseconds' }).fill('50');
  await page.getByRole('spinbutton', { name: 'Cycle in milliseconds' }).press('Tab');
  const before = await captured(page);
  await page.getByRole('switch', { name: 'Send cyclically' }).click();
  await until('many answers', async () => (await captured(page)) > before + 10);
  await page.getByRole('switch', { name: 'Send cyclically' }).click();
  await stays(page, 'the number of frames', () => captured(page), 300);
  await what.fill('read zz');
  await what.press('Tab');
  await page.getByText('is not an object address').waitFor();
  await what.fill('write 6001 = 4096');
  await what.press('Enter');
  await row(page, 'the write', (one) => one.id === '601' && one.data === '23 01 60 00 00 10 00 00');
  await page.reload();
  await becomes('the row that is kept', () => page.getByRole('textbox', { name: 'What to send' }).inputValue(), 'write 6001 = 4096');
});

check('frames that are hard to remember are offered', {}, async (page) => {
  await page.getByRole('combobox', { name: 'Frame templates' }).selectOption({ label: 'Node guarding: request the state' });
  const line = page.getByRole('textbox', { name: 'Frame', exact: true });
  await becomes('the send line', () => line.inputValue(), '701#R1');
  await line.press('Enter');
  await row(page, 'the request', (one) => one.data.includes('remote'));
});

for (const format of ['asc', 'trc', 'pcapng', 'log']) {
  check(`a log goes out and comes in as ${format}`, {}, async (page) => {
    await sdo(page, '1000');
    await row(page, 'the answer', (one) => one.id === '581');
    const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('combobox', { name: 'Save the capture' }).selectOption(format)]);
    const bytes = await readFile(await download.path());
    assert.match(download.suggestedFilename(), new RegExp(`\\.${format}$`));
    await page.getByRole('button', { name: 'Clear' }).click();
    await drop(page, `back.${format}`, bytes);
    await page.getByText('3 frames are in the console').waitFor();
    await row(page, 'the frames', (one) => one.id === '581' && one.data === '43 00 10 00 96 01 02 00');
    await page.getByRole('button', { name: 'Send these frames' }).click();
    await until('an answer to the log', async () => (await captured(page)) > 5);
  });
}

check('a log with faults says which, a file that is none says so', {}, async (page) => {
  await drop(page, 'bad.log', '(0.1) can0 601#4000100000000000\n(0.2) can0 601#4\n');
  await page.getByText('1 line could not be read; the first is line 2').waitFor();
  await drop(page, 'none.trc', 'hello');
  await page.getByText('none.trc cannot be read').waitFor();
});

check('the bus tells how busy it is', {}, async (page) => {
  await sdo(page, '1800:05', '2');
  await becomes('the answer', () => sdoNote(page), /written/);
  await nmt(page, 'Start');
  await becomes('load and frames', () => page.locator('.bus-status').textContent(), /Bus load \d\d+ % of 50 kbit\/s\s+(49\d|50\d) frames\/s/);
});

check('the bits of the chosen frame: fields by name, stuff bits, CRC; a byte marks its field and its object', async (page) => {
  await sendRaw(page, '601#4004600000000000');
  await row(page, 'the request', (one) => one.id === '601');
  await page.locator('.frame:not([hidden])').filter({ hasText: '40 04 60 00' }).first().click();
  await page.getByRole('button', { name: 'Bits', exact: true }).click();
  const bits = page.locator('od-bits');
  // 111 bits counted by hand, stuff bits included; `line::bits` has tests of its own.
  await becomes('the sum', () => bits.locator('.bits-words').textContent(), /^\d{3} bits, \d+ stuff bits, CRC [0-9A-F]{4}h, \d\.\d{3} ms$/);
  const [, all, stuffed] = /^(\d+) bits, (\d+) stuff/.exec(await bits.locator('.bits-words').textContent());
  assert.equal(Number(all) - Number(stuffed), 44 + 64, 'without stuff bits');
  assert.equal(await bits.locator('rect.stuffed').count(), Number(stuffed), 'stuff bits are marked');
  const parts = bits.getByRole('listitem');
  await becomes('fields', async () => (await parts.allTextContents()).map((text) => text.replaceAll(/\s+/g, ' ').trim().split(' ').slice(0, 2).join(' ')).join(', '), /Identifier 601h.*DLC 8, Byte 0, Byte 1.*Byte 7.*CRC/);
  await parts.filter({ hasText: 'Byte 1' }).hover();
  const detail = page.locator('od-frame-detail');
  await becomes('the bytes that are marked', () => detail.locator('.byte[data-lit=true]').count(), 2);
  await becomes('the field of the object', () => detail.locator('.fields li[data-lit=true]').textContent(), /6004h|Position value/);
});
