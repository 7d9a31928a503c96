// Other devices, EDS files, links, a phone, a crash.
import assert from 'node:assert/strict';
import { becomes, booted, nmt, row, rows, sdo, sdoNote, sendRaw, state, until } from './bench.mjs';
import { checks } from './check.mjs';

const GOOD = `[FileInfo]
FileName=little.eds
[DeviceInfo]
VendorName=odkit
ProductName=Little node
[MandatoryObjects]
SupportedObjects=3
1=0x1000
2=0x1001
3=0x1018
[ManufacturerObjects]
SupportedObjects=2
1=0x2000
2=0x2001
[1000]
ParameterName=Device type
ObjectType=0x7
DataType=0x0007
AccessType=ro
DefaultValue=0x00000191
PDOMapping=0
[1001]
ParameterName=Error register
ObjectType=0x7
DataType=0x0005
AccessType=ro
DefaultValue=0
PDOMapping=0
[1018]
ParameterName=Identity object
ObjectType=0x9
SubNumber=2
[1018sub0]
ParameterName=Number of entries
ObjectType=0x7
DataType=0x0005
AccessType=const
DefaultValue=1
PDOMapping=0
[1018sub1]
ParameterName=Vendor ID
ObjectType=0x7
DataType=0x0007
AccessType=ro
DefaultValue=0
PDOMapping=0
[2000]
ParameterName=Lamp brightness
ObjectType=0x7
DataType=0x0005
AccessType=rw
DefaultValue=40
LowLimit=0
HighLimit=100
PDOMapping=0
[2001]
ParameterName=Label on the door
ObjectType=0x7
DataType=0x0009
AccessType=rw
DefaultValue=Pump room, second floor
PDOMapping=0
`;

/** Drops a text or bytes on the page as a file. */
async function drop(page, name, content) {
  const transfer = await page.evaluateHandle(
    ([name, bytes]) => {
      const transfer = new DataTransfer();
      transfer.items.add(new File([Uint8Array.from(bytes)], name, { type: 'text/plain' }));
      return transfer;
    },
    [name, [...Buffer.from(content)]],
  );
  await page.dispatchEvent('body', 'dragover', { dataTransfer: transfer });
  await page.dispatchEvent('body', 'drop', { dataTransfer: transfer });
}

const deviceName = (page) => page.locator('.device-button').textContent();
const note = (page, pattern) => becomes('the note under the SDO line', () => sdoNote(page), pattern);

const check = checks();

check('an EDS file that is dropped runs', {}, async (page) => {
  await booted(page);
  await drop(page, 'little.eds', GOOD);
  await becomes('the name of the device', () => deviceName(page), /Little node|little/);
  await sdo(page, '2000');
  await note(page, /2000h = 40/);
  await sdo(page, 'Lamp brightness', '55');
  await note(page, /2000h written/);
  await sdo(page, '2000', '101');
  await note(page, /0609003[01]/);
  await row(page, 'the object by its name', (one) => /Lamp brightness/.test(one.words));
});

// Windows saves umlauts in one byte each, or in UTF-16 with a byte order mark.
const UMLAUTS = GOOD.replace('Lamp brightness', 'Türöffner').replace('Little node', 'Kleines Gerät');
for (const [coding, encode] of [
  ['latin1', (text) => Buffer.from(text, 'latin1')],
  ['utf16le', (text) => Buffer.from(`\uFEFF${text}`, 'utf16le')],
]) {
  check(`an EDS file in ${coding} runs, and its findings are in their places`, {}, async (page) => {
    await booted(page);
    await drop(page, 'umlauts.eds', encode(UMLAUTS));
    await becomes('the name of the device', () => deviceName(page), /Kleines Gerät/);
    await sdo(page, 'Türöffner');
    await note(page, /2000h = 40/);
    await drop(page, 'broken.eds', encode(UMLAUTS.replace('DefaultValue=40', 'DefaultValue=für 40')));
    const faults = page.getByRole('alert', { name: 'Findings in the file' });
    await until('the faults', () => faults.isVisible());
    const line = UMLAUTS.split('\n').findIndex((one) => one === 'DefaultValue=40') + 1;
    await becomes('the finding', () => faults.locator('li', { hasText: 'E0412' }).textContent(), new RegExp(`${line}:14[^]*DefaultValue=für 40`));
  });
}

check('long texts go in segments, both ways', {}, async (page) => {
  await booted(page);
  await drop(page, 'little.eds', GOOD);
  await becomes('the name of the device', () => deviceName(page), /Little node/);
  await sdo(page, 'Label on the door');
  await note(page, /“Pump room, second floor”/);
  await sdo(page, '2001', 'Boiler room in the basement');
  await note(page, /2001h written/);
  await sdo(page, '2001');
  await note(page, /“Boiler room in the basement”/);
});

check('an EDS file that cannot run says where and why', {}, async (page) => {
  await booted(page);
  const bad = GOOD.replace('DefaultValue=40', 'DefaultValue=forty').replace('DataType=0x0005\nAccessType=rw', 'DataType=0x00FF\nAccessType=rw');
  await drop(page, 'broken.eds', bad);
  const faults = page.getByRole('alert', { name: 'Findings in the file' });
  await until('the faults', () => faults.isVisible());
  await becomes('the file', () => faults.textContent(), /broken\.eds/);
  const line = bad.split('\n').findIndex((text) => text === 'DataType=0x00FF') + 1;
  await until(`line ${line}`, async () => (await faults.locator('.where').allTextContents()).some((where) => where.startsWith(`${line}:`)));
  await becomes('a code', () => faults.textContent(), /E\d{3,4}/);
  await page.keyboard.press('Escape');
  await becomes('the device before stays', () => page.locator('.device-button strong').textContent(), /gxmm/);
  await drop(page, 'broken.eds', bad);
  await page.getByRole('button', { name: 'Run anyway' }).click();
  await becomes('the device without its faults', () => deviceName(page), /Little node/);
  await sdo(page, '1000');
  await note(page, /1000h = /);
});

check('the dialog changes device and node ID, and the link keeps them', {}, async (page) => {
  await booted(page);
  await page.locator('.device-button').click();
  const dialog = page.getByRole('dialog', { name: 'Device on the bus' });
  await dialog.getByRole('spinbutton', { name: 'Node ID' }).fill('5');
  await dialog.getByRole('button', { name: 'gxam' }).click();
  await row(page, 'the boot-up of node 5', (one) => one.id === '705');
  await becomes('the address', () => page.url(), /device=gxam/);
  await page.reload();
  await row(page, 'the boot-up of node 5 after loading', (one) => one.id === '705');
  await becomes('the device', () => deviceName(page), /gxam/);
});

check('a link opens a device', { hash: '#device=gxam&node=33' }, async (page) => {
  await row(page, 'the boot-up of node 33', (one) => one.id === '721');
});

check('a crash of the simulation is not one of the page', {}, async (page) => {
  await booted(page);
  await sendRaw(page, '601#23 01 60 00 E8 03 00 00');
  await row(page, 'the confirmation', (one) => one.id === '581' && one.data.startsWith('60'));
  const break_ = () => page.workers()[0].evaluate(() => void setTimeout(() => { throw new Error('injected'); }));
  await break_();
  await becomes('a word about it', () => page.locator('.toasts').textContent(), /started again/);
  // The run is repeated up to the last moment that the page received.
  await sendRaw(page, '601#4001600000000000');
  await row(page, 'what was written before the crash', (one) => one.id === '581' && one.data.startsWith('43 01 60 00 E8 03'));
  assert.equal((await rows(page)).filter((one) => one.id === '701').length, 1);
  // If it crashes again at once, only the devices are restored.
  await break_();
  await becomes('boot-ups', async () => (await rows(page)).filter((one) => one.id === '701').length, 2);
  await sendRaw(page, '601#4000100000000000');
  await row(page, 'an answer after the crash', (one) => one.id === '581');
});

check('a save that a reset cuts is reported in words', { hash: '#device=en580c&node=1' }, async (page) => {
  await row(page, 'the boot-up', (one) => one.id === '701');
  // The save takes half a second; the reset is sent at the same moment.
  await page.getByRole('button', { name: 'Pause time' }).click();
  await sendRaw(page, '601#2310100173617665');
  await sendRaw(page, '000#8101');
  await becomes('what came of it', () => page.locator('.toasts').textContent(), /Node 1: a save was interrupted; the device loaded its factory values/);
});

/** Checks that no element is wider than its container. */
const fits = (page) => becomes('what has no room', () => overflow(page), []);
const overflow = (page) =>
  page.evaluate(() => [...document.querySelectorAll('html, body, main, .panel, .panel-head, .topbar')].filter((e) => e.scrollWidth > e.clientWidth + 1).map((e) => e.textContent.trim().slice(0, 40)));

for (const width of [820, 1024, 1280, 1920]) {
  check(`${width} pixels wide: everything has room`, { width, height: 700 }, async (page) => {
    await becomes('the state', () => state(page), /Pre-op/);
    await fits(page);
  });
}

check('on a phone an object goes from the dictionary to the SDO line', { width: 390, height: 844 }, async (page) => {
  await page.getByRole('tab', { name: 'Objects' }).click();
  await page.getByRole('searchbox', { name: 'Search objects' }).fill('1018 vendor');
  await page.getByRole('listbox', { name: 'Objects with their live values' }).getByRole('option').filter({ hasText: ':01' }).click();
  await fits(page);
  await page.getByRole('button', { name: 'Read or write' }).click();
  await page.getByRole('button', { name: 'Read', exact: true }).click();
  await note(page, /1018h:01 = 000000ECh/);
});

for (const width of [390, 320]) {
  check(`${width} pixels wide: no sideways scrolling, every panel in reach`, { width, height: 780, hasTouch: true }, async (page) => {
    await becomes('the state', () => state(page), /Pre-op/);
    await fits(page);
    await page.getByRole('tab', { name: 'Bus' }).click();
    await booted(page);
    await nmt(page, 'Start');
    await row(page, 'a PDO1', (one) => one.id === '181');
    await fits(page);
    await page.getByRole('tab', { name: 'Objects' }).click();
    await until('objects', () => page.getByRole('listbox', { name: 'Objects with their live values' }).getByRole('option').first().isVisible());
    await fits(page);
  });
}
