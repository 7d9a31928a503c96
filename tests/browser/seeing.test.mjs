// Figures of each CAN-ID and SDO client, and plots of the whole capture.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { becomes, booted, captured, file, nmt, row, rows, sdo, sdoNote, sendRaw, stays, stopTime, until } from './bench.mjs';
import { checks } from './check.mjs';

const check = checks(booted);

const milliseconds = (text) => Number.parseFloat(text) * (/µs/.test(text) ? 0.001 : / s/.test(text) ? 1000 : 1);
const saved = async (page, name) => {
  const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('button', { name, exact: true }).click()]);
  return { name: download.suggestedFilename(), bytes: await readFile(await download.path()) };
};

check('statistics: period, jitter and last change of a CAN-ID; time to answer and aborts of an SDO client', async (page) => {
  await sdo(page, '1017', '100');
  await becomes('the answer', () => sdoNote(page), /written/);
  await sdo(page, '6001', '9000');
  await becomes('the abort', () => sdoNote(page), /^Value/);
  await page.getByRole('button', { name: 'By CAN-ID' }).click();
  const table = page.getByRole('region', { name: 'By CAN-ID' });
  const cells = (text) => table.getByRole('row').filter({ hasText: text }).first().getByRole('cell').allTextContents();
  await until('ten heartbeats', async () => Number((await cells('701'))[2]) > 10);
  await stopTime(page);
  const [, , count, , least, mean, most, jitter, changed] = await cells('701');
  const [low, middle, high] = [least, mean, most].map(milliseconds);
  assert.ok(low <= middle && middle <= high && Math.abs(low - 100) < 5, `${least} ${mean} ${most}`);
  // The time from the boot-up message to the first heartbeat is a period, too.
  // The three figures have three or four digits: 1.06 s may be 5 ms more.
  assert.ok(milliseconds(jitter) <= high - low + 0.1 + high / 200, `${jitter} of ${least} to ${most}`);
  assert.ok(Number(changed) > 0 && Number(count) > 10, changed);
  assert.match((await cells('601'))[8], /^\d+\.\d{3}$/);
  const client = await page.getByRole('table', { name: 'SDO clients' }).getByRole('row').nth(1).getByRole('cell').allTextContents();
  assert.deepEqual([client[0], client[1], client[5], client[6]], ['1', '2', '1', '0']);
  assert.ok(milliseconds(client[2]) > 0 && milliseconds(client[2]) <= milliseconds(client[4]), client.join());
  // The status bar is below the table, and nothing covers it.
  const bar = await page.locator('.bus-status').boundingBox();
  const box = await page.locator('.ids').boundingBox();
  assert.ok(bar.y >= box.y + box.height - 1, 'the status bar is below');
  await page.getByRole('button', { name: '1', exact: true }).click();
  await becomes('the filter', () => page.getByRole('searchbox', { name: 'Filter frames' }).inputValue(), 'node:1 sdo');
});

check('a plot shows the whole capture by the mapping of the PDOs, on own and shared axes, and keeps it', async (page) => {
  await page.getByRole('spinbutton', { name: 'Speed' }).fill('60');
  await page.keyboard.press('Enter');
  await nmt(page, 'Start');
  await until('some PDOs', async () => (await captured(page)) > 8);
  await page.getByRole('button', { name: 'Plot', exact: true }).click();
  const add = page.getByRole('combobox', { name: 'Plot an object' });
  const option = add.locator('optgroup').first().locator('option', { hasText: 'TPDO1: 6004h Position value' });
  await until('the mapped object', () => option.count());
  await add.selectOption(await option.getAttribute('value'));
  await page.getByRole('combobox', { name: 'Time shown' }).selectOption('0');
  await stopTime(page);
  const file = async () => {
    const { name, bytes } = await saved(page, 'Save the values as CSV');
    assert.equal(name, 'odkit-plot.csv');
    const [head, ...lines] = String(bytes).trim().split('\n');
    return { head, lines: lines.map((line) => line.split(',')) };
  };
  const { head, lines } = await file();
  assert.equal(head, 'time in s,"6004h Position value","Shaft speed in rpm","TPDO1: 6004h Position value"');
  const pdos = lines.filter((line) => line[3] !== '');
  const live = lines.filter((line) => line[1] !== '');
  assert.ok(pdos.length >= 3, 'the PDOs from before the plot was opened');
  assert.ok(Number(pdos[0][0]) < Number(live.at(-1)[0]) - 0.1, 'from before');
  assert.ok(new Set(pdos.map((line) => line[3])).size > 2, 'their values change');
  assert.equal(await page.locator('.plot-area').count(), 3);
  await page.getByRole('button', { name: 'Shared axes' }).click();
  await becomes('charts', () => page.locator('.plot-area canvas').count(), 1);
  await page.getByRole('button', { name: 'In order', exact: true }).click();
  await page.getByRole('button', { name: 'Plot', exact: true }).click();
  await becomes('what is plotted', () => page.locator('.plot figcaption b').allTextContents(), ['6004h Position value', 'Shaft speed in rpm', 'TPDO1: 6004h Position value']);
  assert.deepEqual((await file()).lines, lines, 'the values are kept');
  await page.getByRole('img', { name: /TPDO1: 6004h Position value: .* to / }).waitFor();
  const picture = await saved(page, 'Save the plot as PNG');
  assert.deepEqual([picture.name, [...picture.bytes.subarray(0, 4)]], ['odkit-plot.png', [0x89, 0x50, 0x4e, 0x47]]);
});

check('two cursors show time, values and their differences', async (page) => {
  await page.getByRole('spinbutton', { name: 'Speed' }).fill('60');
  await page.keyboard.press('Enter');
  await page.getByRole('button', { name: 'Plot', exact: true }).click();
  await page.getByRole('combobox', { name: 'Time shown' }).selectOption('0');
  await until('values', () => page.getByRole('img', { name: /^6004h Position value: .* to / }).count());
  await stopTime(page);
  const area = await page.locator('.plot-area .u-over').first().boundingBox();
  for (const part of [0.25, 0.75]) await page.mouse.click(area.x + area.width * part, area.y + area.height / 2);
  const [a, b] = await Promise.all(['A', 'B'].map((name) => page.getByRole('spinbutton', { name: `Cursor ${name} in seconds` }).inputValue().then(Number)));
  assert.ok(b > a && a > 0, `${a} to ${b}`);
  const table = page.getByRole('table', { name: 'Cursors' });
  const line = async (name) => (await table.getByRole('row', { name }).getByRole('cell').allTextContents()).map((text) => text.replaceAll(/[^\d.+−-]/g, ''));
  const value = (text) => Number(text.replace('−', '-'));
  const [timeA, timeB, span] = await line(/^Time/);
  assert.ok(Math.abs(value(timeB) - value(timeA) - value(span)) < 1e-5, `${timeA} ${timeB} ${span}`);
  const [from, to, change] = (await line(/^6004h/)).map(value);
  assert.equal(to - from, change);
  await page.getByRole('spinbutton', { name: 'Cursor B in seconds' }).fill(String(a));
  await page.keyboard.press('Tab');
  await becomes('the difference', async () => (await line(/^Time/))[2], '0');
  await page.getByRole('button', { name: 'Remove the cursors' }).click();
  await becomes('tables of cursors', () => table.count(), 0);
});

const trigger = async (page, text, { before = '', after = '0' } = {}) => {
  if (!(await page.getByRole('textbox', { name: 'Stop the capture at' }).isVisible())) await page.getByRole('button', { name: 'Trigger', exact: true }).click();
  await page.getByRole('textbox', { name: 'Stop the capture at' }).fill(text);
  await page.getByRole('spinbutton', { name: /before the frame/ }).fill(before);
  await page.getByRole('spinbutton', { name: /after the frame/ }).fill(after);
  await page.getByRole('button', { name: /^Arm/ }).click();
};
const said = (page) => page.locator('#trigger-note').textContent();

check('a trigger stops the capture at a frame, marks it, and keeps so much before and after', async (page) => {
  await sdo(page, '1017', '50');
  await row(page, 'heartbeats', (one) => one.id === '701' && one.data === '7F');
  await trigger(page, 'nod:5');
  await becomes('what is wrong', () => said(page), /nod:5: “nod” is not a field/);
  await trigger(page, 'sdo abort', { before: '200', after: '200' });
  await becomes('the state', () => said(page), /^Armed: waits for a frame that passes “sdo abort”/);
  await until('heartbeats meanwhile', async () => (await captured(page)) > 20);
  await sdo(page, '6001', '9000');
  await becomes('the state', () => said(page), /^Fired at \d+\.\d{6} s: the frame is marked, and the capture is stopped\.$/);
  const at = Number(/at ([\d.]+)/.exec(await said(page))[1]);
  await becomes('the marked frame', () => page.locator('.frame[data-marked] .id').allTextContents(), ['581']);
  await until('heartbeats after the frame', async () => (await rows(page)).filter(({ time, id }) => id === '701' && time > at).length >= 3);
  const kept = await rows(page);
  assert.ok(kept.every(({ time }) => time >= at - 0.2001 && time <= at + 0.2001), kept.map(({ time }) => time).join());
  const count = await captured(page);
  await stays(page, 'the number of frames', () => captured(page), 300);
  assert.equal(await captured(page), count);
  await page.getByRole('button', { name: 'Capture stopped' }).waitFor();
  await page.getByRole('button', { name: 'Continue the capture' }).click();
  await until('more frames', async () => (await captured(page)) > count);
});

check('a trigger waits for the value of an object, in a PDO or in the answer to an SDO, and for words', async (page) => {
  await trigger(page, '6004 >= 4000');
  await becomes('the state', () => said(page), /^Armed: waits for 6004h >= 4000 in a PDO or an SDO response\.$/);
  await nmt(page, 'Start');
  await row(page, 'a PDO of a shaft at rest', (one) => one.id === '181');
  await page.getByRole('spinbutton', { name: 'Speed' }).fill('120');
  await page.keyboard.press('Enter');
  await becomes('the state', () => said(page), /^Fired at .* stopped\.$/);
  const value = ({ data }) => Number.parseInt(data.split(' ').reverse().join(''), 16);
  await row(page, 'the PDO that fired', (one) => one.id === '181' && value(one) >= 4000);
  const [last, ...others] = (await rows(page)).filter(({ id }) => id === '181').reverse();
  assert.ok(value(last) >= 4000 && others.every((one) => value(one) < 4000), `${value(last)} after ${others.map(value)}`);
  await trigger(page, '1018:1 != 0');
  await becomes('the state', () => said(page), /^Armed/);
  await sdo(page, '1018:01');
  await becomes('the state', () => said(page), /^Fired/);
  await becomes('the frame', () => page.locator('.frame-detail').textContent(), /Vendor|1018h/);
  await trigger(page, '"heartbeat time"');
  await nmt(page, 'Pre-op');
  await sdo(page, '1017', '100');
  await becomes('the frame', () => page.locator('.frame-detail').textContent(), /Write 1017h/);
});

const LOG = ['(1.000000) can0 601#4004600000000000', '(1.500000) can0 705#05', '(2.000000) can0 601#4018100100000000', '(2.200000) can0 705#05'].join('\n');

async function openLog(page, name, text) {
  const transfer = await page.evaluateHandle(([file, body]) => {
    const data = new DataTransfer();
    data.items.add(new File([body], file));
    return data;
  }, [name, text]);
  await page.dispatchEvent('body', 'drop', { dataTransfer: transfer });
}

const ids = async (page) => (await rows(page)).map(({ id }) => id).join(' ');

check('a log never throws the capture away unasked: beside it, after it is saved, or in its place', async (page) => {
  await sdo(page, '6004');
  await row(page, 'the answer', (one) => one.id === '581');
  const offer = page.getByRole('region', { name: 'Offers' });
  const shown = page.getByRole('group', { name: 'What the console shows' });
  await openLog(page, 'other.log', LOG);
  await offer.getByText('other.log has 4 frames. The capture has 3.').waitFor();
  assert.equal(await ids(page), '701 601 581', 'nothing is thrown away');
  await offer.getByRole('button', { name: 'Open beside it' }).click();
  await becomes('the log', () => ids(page), '601 705 601 705');
  // Frames received meanwhile go to the capture.
  await sdo(page, '1000');
  await becomes('the answer', () => sdoNote(page), /1000h = /);
  assert.equal(await ids(page), '601 705 601 705');
  await shown.getByRole('button', { name: 'Capture' }).click();
  await becomes('the capture', () => ids(page), '701 601 581 601 581');
  await shown.getByRole('button', { name: 'other.log', exact: true }).click();
  await becomes('the log', () => ids(page), '601 705 601 705');
  await shown.getByRole('button', { name: 'Close other.log' }).click();
  await becomes('the capture', () => ids(page), '701 601 581 601 581');
  await openLog(page, 'other.log', LOG);
  const [download] = await Promise.all([page.waitForEvent('download'), offer.getByRole('button', { name: 'Save the capture, then replace it' }).click()]);
  assert.equal(String(await readFile(await download.path())).trim().split('\n').length, 5);
  await becomes('the log in its place', () => ids(page), '601 705 601 705');
  // A log without added frames is replaced without a question.
  await openLog(page, 'next.log', LOG.split('\n')[0]);
  await becomes('the next log', () => ids(page), '601');
  // Of a log of two buses, one is shown.
  await openLog(page, 'two.log', LOG.replaceAll('can0 705', 'can1 705'));
  await offer.getByText('two.log has the frames of 2 buses.').waitFor();
  await offer.getByRole('button', { name: 'can1 (2 frames)' }).click();
  await becomes('the second bus', () => ids(page), '705 705');
});

check('a log in the send list runs onto the bus and only to be looked at, at any speed, held and frame by frame', async (page) => {
  await openLog(page, 'other.log', LOG);
  await page.getByRole('button', { name: 'Open beside it' }).click();
  const log = page.getByRole('group', { name: 'Log other.log' });
  assert.equal(await page.locator('.send-list').getByRole('group').count(), 1, 'it has its place in the send list');
  const button = (name) => log.getByRole('button', { name, exact: true });
  const place = () => log.getByRole('progressbar').evaluate((bar) => bar.value);
  // Frame by frame onto the bus: one request, one response.
  await button('Next frame of the log').click();
  await becomes('frames on the bus', () => ids(page), '701 601 581');
  await becomes('the progress', place, 1);
  await log.getByText('1 of 4 frames, 0.000 s').waitFor();
  await button('Next frame of the log').click();
  await becomes('frames on the bus', () => ids(page), '701 601 581 705');
  // Then it continues, ten times as fast.
  await log.getByRole('spinbutton', { name: 'Speed of the log' }).fill('10');
  await page.keyboard.press('Tab');
  await button('Continue the log').click();
  await becomes('frames on the bus', () => ids(page), '701 601 581 705 601 581 705');
  await button('Start the log').waitFor();
  await becomes('the progress', place, 4);
  const [asked, , last] = (await rows(page)).slice(-3).map(({ time }) => time);
  assert.ok(Math.abs(last - asked - 0.02) < 0.005, `0.2 s of the log in ${last - asked} s`);
  // In the console only: nothing is sent, and the log is shown again. Its last frame is much later.
  await button('Remove the log from the send list').click();
  await openLog(page, 'other.log', ['(1.0) can0 705#05', '(1.1) can0 705#7F', '(900.0) can0 705#04'].join('\n'));
  await page.getByRole('button', { name: 'Open beside it' }).click();
  await log.getByRole('combobox', { name: 'Where the frames go' }).selectOption({ label: 'Only to look at' });
  await button('Next frame of the log').click();
  await becomes('the first frame', () => ids(page), '705');
  await button('Continue the log').click();
  await becomes('the next frame', place, 2);
  await button('Hold the log').click();
  await button('Continue the log').waitFor();
  await becomes('what is shown', () => ids(page), '705 705');
  await button('End the log').click();
  await becomes('the whole log', () => ids(page), '705 705 705');
  await page.getByRole('group', { name: 'What the console shows' }).getByRole('button', { name: 'Capture' }).click();
  await becomes('the capture', () => ids(page), '701 601 581 705 601 581 705');
  await button('Remove the log from the send list').click();
  await becomes('logs in the send list', () => log.count(), 0);
});

/** A node with a heartbeat that restarts three times without a command. */
const RESTARTS = Array.from({ length: 40 }, (_, at) => `(${(at / 10).toFixed(6)}) can0 705#${at % 10 === 0 ? '00' : '05'}`).join('\n');

check('the diagnosis of a log names the faults, their causes and the frames, and shows a frame in the console', async (page) => {
  await stopTime(page);
  await page.getByLabel('Open log').setInputFiles(file('restarts.log', RESTARTS));
  await page.getByRole('button', { name: 'Replace the capture', exact: true }).click();
  await becomes('the frames', () => captured(page), 40);
  await page.getByRole('button', { name: 'Diagnosis', exact: true }).click();
  const region = page.getByRole('region', { name: 'Diagnosis' });
  await becomes('what was found', () => region.getByRole('status').textContent(), /^1 fault in 40 frames\./);
  await becomes('the fault', () => region.getByRole('heading').allTextContents(), ['node 5 restarts 3 times without a command']);
  assert.match(await region.textContent(), /Check: /);
  const shown = region.getByRole('list', { name: 'Frames that show it' }).getByRole('button');
  assert.match(await shown.nth(1).textContent(), /^1\.000000 705 00$/);
  await shown.nth(1).click();
  await becomes('the chosen frame', () => page.locator('.frame[data-chosen] .time').allTextContents(), ['1.000000']);
  await page.getByRole('button', { name: 'Diagnosis', exact: true }).click();
  await page.getByRole('button', { name: 'Clear', exact: true }).click();
  await page.getByRole('button', { name: 'Look again', exact: true }).click();
  await becomes('what was found', () => region.getByRole('status').textContent(), /^No fault in 0 frames\./);
});

check('the diagnosis of a log without times says so, and shows its frames without times', async (page) => {
  await stopTime(page);
  const typed = ['0x705: 00', '0x705: 05', '0x601: 40 00 10 00 00 00 00 00', '0x705: 00', '0x705: 05', '0x705: 00'].join('\n');
  await page.getByLabel('Open log').setInputFiles(file('typed.txt', typed));
  await page.getByRole('button', { name: 'Replace the capture', exact: true }).click();
  await becomes('the frames', () => captured(page), 6);
  await page.getByRole('button', { name: 'Diagnosis', exact: true }).click();
  const region = page.getByRole('region', { name: 'Diagnosis' });
  await region.getByText('The frames have no times, so only faults of their order are found.').waitFor();
  await becomes('the fault', () => region.getByRole('heading').allTextContents(), ['node 5 restarts 2 times without a command']);
  const shown = await region.getByRole('list', { name: 'Frames that show it' }).getByRole('button').allTextContents();
  assert.ok(shown.includes('705 00'), shown.join('\n'));
  await openLog(page, 'truck.log', '(1.0) can0 0CF00400#F07D7D0020000000\n(1.1) can0 18FEF100#FF\n');
  await becomes('the frames', () => captured(page), 2);
  await region.getByRole('button', { name: 'Look again' }).click();
  await region.getByText('These frames are not CANopen: all CAN-IDs have 29 bits').waitFor();
});

check('the nodes of the bus: state, heartbeat, EMCY and device, from the frames', { hash: '#device=gxmm&node=1&device=gcam&node=6' }, async (page) => {
  await page.getByRole('button', { name: 'Nodes' }).click();
  const table = page.getByRole('region', { name: 'Nodes' });
  const cells = (number) => table.getByRole('row').nth(number).getByRole('cell').allInnerTexts();
  await becomes('two nodes', async () => [await cells(1), await cells(2)].map((row) => row.slice(0, 5)), [['1', 'gxmm', 'Pre-operational', 'none', 'none'], ['6', 'gcam', 'Pre-operational', 'none', 'none']]);
  // A command is a guess until a heartbeat confirms it.
  await sendRaw(page, '000#0106');
  await becomes('the ordered state', async () => (await cells(2))[2], 'Operational ?');
  await sendRaw(page, '606#2B171000C8000000');
  await becomes('the confirmed state', async () => (await cells(2))[2], 'Operational');
  await becomes('the heartbeat', async () => (await cells(2))[3], /^0\.\d s ago, every 0\.2 s$/);
  await sendRaw(page, '081#3081110000000000');
  await becomes('the error', async () => (await cells(1))[4], /8130h life guard or heartbeat error/);
  await table.getByRole('button', { name: '6', exact: true }).click();
  await becomes('the filter', () => page.getByRole('searchbox', { name: 'Filter' }).inputValue(), 'node:6');
});

check('a DBC file adds its signals to the words of frames, until it is closed', async (page) => {
  const dbc = 'VERSION ""\n\nBU_: A\n\nBO_ 389 Motion: 8 A\n SG_ Speed : 0|16@1- (0.5,0) [0|0] "rpm" A\n SG_ Mode : 16|8@1+ (1,0) [0|0] "" A\n\nVAL_ 389 Mode 3 "torque" ;\n';
  const open = (name, text) => page.locator('od-console input[type=file]').setInputFiles(file(name, text));
  await sendRaw(page, '185#F6FF03');
  await open('motion.dbc', dbc);
  await row(page, 'the signals', (one) => one.id === '185' && one.words.endsWith('| Motion: Speed -5.0 rpm, Mode torque'));
  // Frames that come later have them, too.
  await sendRaw(page, '185#0200');
  await row(page, 'the next signals', (one) => one.id === '185' && one.words.endsWith('| Motion: Speed 1.0 rpm'));
  await page.getByRole('searchbox', { name: 'Filter' }).fill('torque');
  await becomes('the rows', async () => (await rows(page)).length, 1);
  await page.getByRole('searchbox', { name: 'Filter' }).fill('');
  // Two signals that no frame of 8 bytes can hold are counted.
  await open('long.dbc', dbc.replace(' SG_ Speed', ' SG_ Long : 0|99@1+ (1,0) [0|0] "" A\n SG_ Late : 60|8@1+ (1,0) [0|0] "" A\n SG_ Speed'));
  await page.getByText('Not shown, as no frame of 8 bytes can hold them: 2 signals.').waitFor();
  await open('motion.dbc', dbc);
  await open('wrong.dbc', 'VERSION ""\nBO_ x\n');
  await page.getByText('wrong.dbc cannot be read: line 2: `BO_ x` is not a line of a DBC file.').waitFor();
  await page.getByRole('button', { name: 'Close motion.dbc' }).click();
  await row(page, 'the plain words', (one) => one.id === '185' && !one.words.includes('Motion'));
});
