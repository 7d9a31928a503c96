// The packed tarballs as somebody gets them: `npm pack`, unpack, and run the example page of
// playground/README.md. `ODKIT_PKG` is the package for `web`, `ODKIT_PKG_BUNDLER` the other.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';

const own = (name) => readFileSync(new URL(name, import.meta.url), 'utf8');
const page = own('example.html');

let root;
before(() => (root = mkdtempSync(join(tmpdir(), 'odkit-tarball-'))));
after(() => rmSync(root, { recursive: true, force: true }));

/** A folder with a package of its own in it; the tarball's files are all it has. */
function install(package_, name) {
  assert.ok(package_, `the folder of the ${name} package is not given`);
  const folder = join(root, name);
  const to = join(folder, 'node_modules', 'od-playground');
  mkdirSync(to, { recursive: true });
  execFileSync('npm', ['pack', '--silent', '--ignore-scripts', '--pack-destination', folder], { cwd: package_, stdio: ['ignore', 'ignore', 'inherit'] });
  const tarball = readdirSync(folder).find((one) => one.endsWith('.tgz'));
  execFileSync('tar', ['-xzf', tarball, '--strip-components=1', '-C', to], { cwd: folder });
  return { folder, files: readdirSync(to), about: JSON.parse(readFileSync(join(to, 'package.json'), 'utf8')) };
}

/** Runs a text as a module in a process of its own; what it printed. */
function run(folder, text, ...flags) {
  writeFileSync(join(folder, 'page.mjs'), text);
  return execFileSync(process.execPath, ['--no-warnings', ...flags, 'page.mjs'], { cwd: folder, encoding: 'utf8' });
}

// As much of a browser as the page needs: two elements, and fetch of a file beside it.
const BROWSER = `
import { readFile } from 'node:fs/promises';
const elements = { log: { text: '', append(text) { this.text += text; } }, position: {} };
globalThis.document = { getElementById: (id) => elements[id] };
globalThis.fetch = async (url) => new Response(await readFile(new URL(url)), { headers: { 'content-type': 'application/wasm' } });
process.on('exit', () => console.log(JSON.stringify({ log: elements.log.text, position: elements.position.textContent })));
`;

test('the tarball has what package.json names, with types', () => {
  const { files, about } = install(process.env.ODKIT_PKG, 'contents');
  assert.equal(about.name, 'od-playground');
  assert.equal(about.type, 'module');
  for (const name of [about.main, about.types, 'od_playground_bg.wasm', 'README.md', 'LICENSE.MIT', 'LICENSE.APACHE']) assert.ok(files.includes(name), name);
  const types = readFileSync(join(root, 'contents', 'node_modules', 'od-playground', about.types), 'utf8');
  for (const signature of ['addDevice(name: string, node_id: number', 'drain(): Uint8Array', '): EdsResult', 'Diagnostic[]', 'export interface Diagnostic']) {
    assert.ok(types.includes(signature), signature);
  }
  // Behind it are the raw functions of the module, which nobody calls.
  const [written] = types.split('export type InitInput');
  assert.doesNotMatch(written, /: any\b/, 'every function has a type');
});

test('the example page of the README runs from the tarball', () => {
  const readme = own('../README.md');
  const quoted = readme.split('```html\n')[1]?.split('```\n')[0];
  assert.equal(quoted, page, 'playground/README.md quotes package-test/example.html');
  const { folder } = install(process.env.ODKIT_PKG, 'web');
  const script = page.match(/<script type="module">\n([^]*)<\/script>/)[1];
  writeFileSync(join(folder, 'browser.mjs'), BROWSER);
  const { log, position } = JSON.parse(run(folder, script, '--import', './browser.mjs'));
  const lines = log.trimEnd().split('\n');
  assert.ok(lines.some((line) => /^error E\d+, line 3: /.test(line)), log);
  const words = lines.find((line) => line.includes('585') && line.includes('6004h'));
  assert.match(words ?? '', /12288/, log);
  assert.ok(lines.some((line) => / µs 705 /.test(line)), 'the boot-up message');
  assert.ok(lines.some((line) => / µs 185 /.test(line)), 'a PDO');
  assert.equal(position, 12288 + 8192, 'a turn and a half, and a second of 60 rpm');
});

test('the package for bundlers does the same without `init`', () => {
  const { folder } = install(process.env.ODKIT_PKG_BUNDLER, 'bundler');
  const text = `
    import { Bus } from 'od-playground';
    const bus = new Bus();
    const device = bus.addDevice('gxmm', 5);
    bus.turnTo(device, 1.5);
    bus.advance(10_000, 100);
    console.log(bus.pending(), bus.read(device, 0x6004, 0), bus.nmt(device));`;
  assert.equal(run(folder, text, '--experimental-wasm-modules').trim(), '1 12288 pre-operational');
});
