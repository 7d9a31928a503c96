// The npm package as another page would use it; `ODKIT_PKG` names its folder.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { before, test } from 'node:test';
import { pathToFileURL } from 'node:url';

const folder = process.env.ODKIT_PKG ?? new URL('../web/src/wasm/', import.meta.url).pathname;
const at = (name) => new URL(name, `${pathToFileURL(folder)}/`);

let odkit;
before(async () => {
  odkit = await import(at('od_playground.js').href);
  odkit.initSync({ module: await readFile(at('od_playground_bg.wasm')) });
});

/** The frames of a batch, in words. */
function frames(bus) {
  const batch = bus.drain();
  const all = [];
  for (let offset = 0; offset < batch.length; offset += 24) {
    const view = new DataView(batch.buffer, batch.byteOffset + offset, 24);
    const flags = view.getUint8(12);
    all.push({
      time: view.getFloat64(0, true),
      id: view.getUint32(8, true),
      remote: (flags & 2) !== 0,
      own: (flags & 4) !== 0,
      data: Buffer.from(batch.subarray(offset + 16, offset + 16 + view.getUint8(13))).toString('hex'),
      words: bus.describe(batch.subarray(offset, offset + 24)),
    });
  }
  return all;
}

const bytes = (hex) => Uint8Array.from(Buffer.from(hex, 'hex'));

test('a device boots, answers, and runs', () => {
  const bus = new odkit.Bus();
  const device = bus.addDevice('gxmm', 5);
  bus.advance(10_000, 100);
  assert.deepEqual(frames(bus).map((one) => [one.id, one.data]), [[0x705, '00']]);
  assert.equal(bus.nmt(device), 'pre-operational');
  assert.deepEqual(bus.leds(device), { green: 'flashing', red: 'off' });

  bus.turnTo(device, 1.5);
  bus.send(0x605, bytes('4004600000000000'), false, false);
  const [request, answer] = frames(bus);
  assert.ok(request.own && !answer.own);
  assert.equal(answer.data, '4304600000300000');
  assert.match(answer.words, /6004h.*12288/);
  assert.equal(bus.read(device, 0x6004, 0), 12288);
  assert.equal(bus.pending(), 0, 'reading puts nothing on the bus');

  bus.send(0, bytes('0100'), false, false);
  bus.setRpm(device, 60);
  assert.equal(bus.advance(2_000_000, 1000), 2_000_000);
  assert.equal(bus.nmt(device), 'operational');
  assert.ok(frames(bus).filter((one) => one.id === 0x185).length >= 3);
  assert.equal(Math.round(bus.shaft(device).turns * 1000), 3500);

  bus.setPower(device, false);
  bus.send(0x605, bytes('4004600000000000'), false, false);
  bus.advance(1_000_000, 1000);
  assert.equal(frames(bus).length, 1, 'nobody answers');
  assert.equal(bus.read(device, 0x6004, 0), null);
  assert.equal(bus.nmt(device), 'off');
});

test('the dictionary comes as plain records', () => {
  const bus = new odkit.Bus();
  const rows = bus.dictionary(bus.addDevice('gxmm', 7));
  const row = (index, sub) => rows.find((one) => one.index === index && one.sub === sub);
  assert.equal(Object.getPrototypeOf(rows[0]), Object.prototype);
  assert.deepEqual(row(0x6004, 0), {
    index: 0x6004, sub: 0, name: 'Position value', parent: null, type: 'UNSIGNED32', bits: 32,
    access: 'ro', mappable: true, fitsTpdo: true, fitsRpdo: false, isMapping: false, isSaved: false, default: row(0x6004, 0).default, low: row(0x6004, 0).low, high: row(0x6004, 0).high,
  });
  assert.equal(row(0x1018, 1).parent !== null && row(0x1018, 1).default, 0xec);
  assert.equal(row(0x1800, 1).default, 0x187, 'the node ID is in the defaults');
});

test('the limits of a call: as many frames as asked for', () => {
  const bus = new odkit.Bus();
  bus.addDevice('gxmm', 1);
  bus.send(0x601, bytes('2b00180501000000'), false, false);
  bus.send(0, bytes('0101'), false, false);
  frames(bus);
  const passed = bus.advance(10_000_000, 10);
  assert.ok(passed < 10_000_000);
  assert.equal(bus.pending(), 10);
});

test('several devices hear each other and outsiders', () => {
  const bus = new odkit.Bus();
  bus.addDevice('gxmm', 1);
  bus.addDevice('gxam', 2);
  bus.send(0, bytes('0100'), false, false);
  bus.advance(1_000_000, 1000);
  const ids = new Set(frames(bus).map((one) => one.id));
  for (const id of [0x701, 0x702, 0x181, 0x182]) assert.ok(ids.has(id), id.toString(16));
});

test('the same inputs give the same bytes', () => {
  const run = () => {
    const bus = new odkit.Bus();
    const device = bus.addDevice('gxmm', 1);
    bus.setRpm(device, 123.4);
    bus.send(0, bytes('0101'), false, false);
    bus.advance(3_000_000, 1000);
    return Buffer.from(bus.drain()).toString('hex');
  };
  assert.equal(run(), run());
});

test('wrong names and node IDs are errors, not crashes', () => {
  const bus = new odkit.Bus();
  assert.throws(() => bus.addDevice('gxqq', 1), /gxqq/);
  assert.throws(() => bus.addDevice('gxmm', 0), /1 to 127/);
  assert.throws(() => bus.addDevice('gxmm', 128), /1 to 127/);
  bus.setPower(99, true);
  bus.setRpm(99, Number.NaN);
  assert.equal(bus.read(99, 0x6004, 0), null);
  assert.equal(bus.shaft(99), null);
  assert.deepEqual(bus.dictionary(99), []);
  assert.equal(bus.describe(new Uint8Array(3)), '');
  const device = bus.addDevice('gxmm', 1);
  for (const odd of [Number.NaN, Infinity, -Infinity, 1e300]) {
    bus.setRpm(device, odd);
    bus.turnTo(device, odd);
    bus.advance(Number.isFinite(odd) ? 1000 : 1000, 10);
  }
  bus.send(0xffffffff, new Uint8Array(100), true, false);
  bus.send(0xffffffff, new Uint8Array(100), false, true);
});

test('an EDS text runs, or says what is wrong with it', () => {
  const bus = new odkit.Bus();
  const bad = bus.addEds('[1000]\nParameterName=Device type\nDataType=0x0099\n', 1);
  assert.equal(bad.device, null);
  assert.ok(bad.diagnostics.some((one) => one.severity === 'error' && one.line === 3 && one.object.includes('1000')));
  assert.ok(bad.diagnostics.every((one) => one.code && one.message));
  assert.notEqual(bus.addEds('[1000]\nParameterName=Device type\nDataType=0x0099\n', 1, true).device, null);
  assert.deepEqual(odkit.checkEds('[1000]\nParameterName=Device type\nDataType=0x0099\n'), bad.diagnostics);
});

test('the devices that there are', () => {
  const names = odkit.builtinDevices().map((one) => one.name);
  assert.ok(names.includes('gxmm') && names.includes('gxam'), String(names));
});

test('a device as it is set up becomes a DCF, and the DCF the same device', () => {
  const bus = new odkit.Bus();
  const device = bus.addDevice('gxmm', 5);
  bus.deliver(device, 0x605, bytes('2301600000100000'));
  bus.deliver(device, 0x605, bytes('2b171000f4010000'));
  const dcf = bus.exportDcf(device, 'gxmm');
  assert.match(dcf, /\[DeviceComissioning\][^[]*NodeID=5\n/i);
  assert.equal(dcf.match(/ParameterValue=/g).length, 3, '6001h, 1017h, and the node ID in 2101h');
  const other = new odkit.Bus();
  const { device: again } = other.addEds(dcf, 5);
  assert.equal(other.read(again, 0x6001, 0), 4096);
  assert.equal(other.read(again, 0x1017, 0), 500);
  assert.equal(other.exportDcf(again, undefined, dcf), dcf);
  assert.throws(() => bus.exportDcf(device, 'nothing'));
  assert.throws(() => bus.exportDcf(7, 'gxmm'));
});

test('what is not saved lives on in an image', () => {
  const bus = new odkit.Bus();
  const device = bus.addDevice('gcam', 3);
  bus.deliver(device, 0x603, bytes('2301600000080000'));
  const before = bus.eeprom(device);
  const image = bus.image(device);
  assert.deepEqual(bus.eeprom(device), before, 'the EEPROM itself stays');
  const other = new odkit.Bus();
  const copy = other.addDevice('gcam', 3);
  other.setEeprom(copy, image);
  other.setPower(copy, false);
  other.setPower(copy, true);
  assert.equal(other.read(copy, 0x6001, 0), 2048);
});

const lessonText = await readFile(new URL('../lessons/01-boot-up-and-heartbeat.md', import.meta.url), 'utf8');

test('a lesson is read, taken, and pauses the bench at each checkpoint', () => {
  const { lesson, problems } = odkit.parseLesson(lessonText);
  assert.deepEqual(problems, []);
  assert.equal(lesson.title, 'Boot-up and heartbeat');
  assert.equal(lesson.steps[0].quiz.answer, '705#00');
  assert.deepEqual(odkit.judgeAnswer('705#00', '7F').wrongBytes, [0]);
  assert.throws(() => odkit.judgeAnswer('705#00', 'what'));

  const bus = new odkit.Bus(1000);
  assert.equal(bus.lesson(), null);
  bus.startLesson(lessonText);
  assert.equal(bus.now(), 1000);
  assert.equal(bus.advance(1_000_000, 100), 1_000_000, 'waiting reaches nothing');
  assert.deepEqual(bus.lesson().requirements, [{ holds: false, text: 'the boot-up message of node 5 comes' }]);

  bus.setPower(0, true);
  assert.deepEqual([...bus.lessonEvents()], [], 'the boot-up message takes its time on the line');
  const booted = bus.advance(2_000_000, 100);
  assert.ok(booted > 0 && booted < 10_000, `it stops where the boot-up message is: ${booted}`);
  assert.deepEqual([...bus.lessonEvents()], [0]);
  bus.send(0x605, bytes('2b171000f4010000'), false, false);
  const third = bus.advance(10_000_000, 1000);
  assert.ok(third > 1_500_000 && third < 1_510_000, `it stops where the third heartbeat is: ${third}`);
  assert.deepEqual([...bus.lessonEvents()], [1]);
  const state = bus.lesson();
  assert.equal(state.step, 2);
  assert.equal(state.reached.length, 2);
  assert.ok(bus.advance(100_000, 1000) > 0, 'it goes on');

  for (const step of lesson.steps.slice(2)) bus.runScript(step.solution);
  assert.ok(bus.lesson().done);
  assert.ok(frames(bus).some((one) => one.own && one.id === 0), 'frames of a script are in the trace');
  bus.beginStep(0);
  assert.equal(bus.lesson().step, 0);
  bus.endLesson();
  assert.equal(bus.lesson(), null);
});

test('what is wrong with a lesson or a script is said with its line', () => {
  const { lesson, problems } = odkit.parseLesson('+++\ntitle = 5\n+++\n## a\n```checkpoint\ncame 7\n```\n');
  assert.equal(lesson, null);
  assert.ok(problems.some((one) => one.line === 6 && one.message.includes('is not a frame') && one.help));
  const bus = new odkit.Bus();
  bus.addDevice('gxmm', 1);
  assert.throws(() => bus.startLesson('nothing'), /1:1: the lesson has no/);
  assert.equal(bus.deviceCount(), 1, 'the bench stays');
  assert.throws(() => bus.runScript('nmt explode'), /1:5: NMT command `explode` does not exist/);
  assert.throws(() => bus.runScript('sdo read 5555h'), /line 1 /);
  assert.equal(bus.nmt(0), 'pre-operational', 'the bus is still there');
});

test('the language server finds, fixes and compares what an editor has', () => {
  const text = odkit.deviceEds('gxmm');
  assert.equal(odkit.deviceEds('nothing'), undefined);
  const uri = 'page:1/gxmm.eds';
  const server = new odkit.LanguageServer();
  /** Sends a message; the answers. */
  const say = (message) => {
    server.receive(JSON.stringify({ jsonrpc: '2.0', ...message }));
    while (server.step());
    const all = [];
    for (let one = server.poll(); one !== undefined; one = server.poll()) all.push(JSON.parse(one));
    return all;
  };
  say({ id: 0, method: 'initialize', params: { capabilities: {} } });
  const wrong = text.replace('[6001]', '[6001]\nHighLimit=many');
  const [{ params }] = say({ method: 'textDocument/didOpen', params: { textDocument: { uri, languageId: '', version: 1, text: wrong } } });
  assert.ok(params.diagnostics.some((one) => odkit.ruleTitles()[one.code] && one.message.includes('`many`')));
  const line = wrong.split('\n').indexOf('HighLimit=many');
  const position = { line, character: 12 };
  const [{ result }] = say({ id: 1, method: 'textDocument/hover', params: { textDocument: { uri }, position } });
  assert.match(result.contents.value, /Source: /);

  assert.deepEqual(odkit.compareEds(text, text), []);
  const [found] = odkit.compareEds(text, text.replace(/\[2800\][^]*?DefaultValue=0/, (section) => section.replace(/0$/, '5')));
  assert.deepEqual(found, { place: '2800h', name: 'TPDO1 repeat counter', change: 'default 0 -> 5', breaking: false });
  const latin = odkit.encodeEds(Uint8Array.from(Buffer.from('[FileInfo]\nCreatedBy=Müller\n', 'latin1')), '[FileInfo]\nCreatedBy=Bär\n');
  assert.equal(Buffer.from(latin).toString('latin1'), '[FileInfo]\nCreatedBy=Bär\n');
});
