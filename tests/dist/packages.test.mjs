// The packages for the registries of Rust, Python, npm and Visual Studio Code, installed from the folder only.
import assert from 'node:assert/strict';
import { appendFileSync, chmodSync, copyFileSync, mkdirSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import { homedir } from 'node:os';
import { basename, join, resolve } from 'node:path';
import { test } from 'node:test';
import { dist, file, room } from './room.mjs';

/** The wheel for this computer. */
const WHEEL = new RegExp(`manylinux2014_${process.arch === 'arm64' ? 'aarch64' : 'x86_64'}.*\\.whl$`);

test('checksums and README name every file', () => {
  const { run } = room('sums');
  run('sha256sum', ['--check', '--quiet', '--strict', 'SHA256SUMS'], { cwd: dist });
  const sums = readFileSync(join(dist, 'SHA256SUMS'), 'utf8').trim().split('\n');
  const all = readdirSync(dist, { recursive: true, withFileTypes: true }).filter((one) => one.isFile());
  assert.equal(sums.length, all.length - 1, 'all but SHA256SUMS');
  const readme = readFileSync(join(dist, 'README.md'), 'utf8');
  for (const { name } of readdirSync(dist, { withFileTypes: true }).filter((one) => one.isDirectory())) assert.match(readme, new RegExp(`^## ${name}$`, 'm'));
});

test('a wheel for each system, and the sources for the others', () => {
  for (const system of [/manylinux2014_x86_64/, /manylinux2014_aarch64/, /musllinux_1_2_x86_64/, /musllinux_1_2_aarch64/, /win_amd64\.whl$/, /\.tar\.gz$/]) file('python', system);
});

test('the wheel is a bus of python-can', () => {
  const { dir, run } = room('python');
  run('python3', ['-m', 'venv', 'venv']);
  const python = join(dir, 'venv/bin/python');
  run(python, ['-m', 'pip', 'install', '--quiet', 'python-can>=4.4', 'canopen>=2.3', 'pytest']);
  run(python, ['-m', 'pip', 'install', '--quiet', '--no-index', '--no-deps', file('python', WHEEL)]);
  writeFileSync(
    join(dir, 'test_bus.py'),
    `import can

def test_position(odkit_bench, odkit_bus):
    odkit_bench["gxmm"].turns = 2.5
    request = bytes.fromhex("40 04 60 00 00 00 00 00")
    odkit_bus.send(can.Message(arbitration_id=0x601, is_extended_id=False, data=request))
    answer = next(message for message in odkit_bus if message.arbitration_id == 0x581)
    assert int.from_bytes(answer.data[4:], "little") == 2.5 * 8192

def test_interface():
    with can.Bus(interface="odkit", channel="eam_mt@2") as bus:
        assert bus.recv(1).arbitration_id == 0x702
`,
  );
  assert.match(run(python, ['-m', 'pytest', '-q', '--color=no']), /2 passed/);
  const sources = run('tar', ['-tzf', file('python', /\.tar\.gz$/)]);
  for (const name of ['PKG-INFO', 'pyproject.toml', 'python/Cargo.toml', 'crates/od-sim/Cargo.toml']) assert.match(sources, new RegExp(`/${name}$`, 'm'));
});

test('the npm package boots an encoder', () => {
  const { dir, run } = room('npm');
  writeFileSync(join(dir, 'package.json'), '{ "name": "own", "private": true, "type": "module" }\n');
  run('npm', ['install', '--offline', '--silent', file('npm', /\.tgz$/)]);
  writeFileSync(
    join(dir, 'boot.js'),
    `import { readFile } from 'node:fs/promises';
import init, { Bus } from 'od-playground';
await init({ module_or_path: await readFile(new URL('./node_modules/od-playground/od_playground_bg.wasm', import.meta.url)) });
const bus = new Bus();
const device = bus.addDevice('gxmm', 5);
bus.turnTo(device, 1.5);
bus.advance(10_000, 100);
console.log(bus.pending(), bus.read(device, 0x6004, 0), bus.nmt(device));
`,
  );
  assert.equal(run('node', ['boot.js']).trim(), '1 12288 pre-operational');
});

// Everything that an extension may use of its editor when it is loaded: classes, functions and values of any name.
const EDITOR = `
const Module = require('node:module');
const any = () => new Proxy(class {}, { get: (own, key) => (key in own || typeof key === 'symbol' ? own[key] : (own[key] = any())) });
const load = Module._load;
Module._load = (name, ...rest) => (name === 'vscode' ? any() : load(name, ...rest));
const about = require('./extension/package.json');
const extension = require(require.resolve('./extension/' + about.main));
console.log(about.name, typeof extension.activate);
`;

test('the extension unpacks and loads', () => {
  const { dir, run } = room('vscode');
  run('python3', ['-m', 'zipfile', '-e', file('vscode', /\.vsix$/), '.']);
  writeFileSync(join(dir, 'load.cjs'), EDITOR);
  assert.equal(run('node', ['load.cjs']).trim(), 'odkit function');
  const { contributes } = JSON.parse(readFileSync(join(dir, 'extension/package.json'), 'utf8'));
  for (const { path } of contributes.grammars) JSON.parse(readFileSync(join(dir, 'extension', path), 'utf8'));
});

test('a new device is made of the packed crates', () => {
  const { dir, run } = room('crates');
  const odkit = join(dir, 'odkit');
  copyFileSync(file('bin', /x86_64-unknown-linux-musl$/), odkit);
  chmodSync(odkit, 0o755);
  run(odkit, ['new', 'gxmm', '--name', 'encoder', '--registry']);
  mkdirSync(join(dir, 'packed'));
  const patches = ['\n[patch.crates-io]'];
  for (const name of readdirSync(join(dist, 'crates')).filter((one) => one.endsWith('.crate'))) {
    run('tar', ['-xzf', join(dist, 'crates', name), '-C', 'packed']);
    const folder = name.replace(/\.crate$/, '');
    patches.push(`${folder.replace(/-[\d.]+$/, '')} = { path = "../packed/${folder}" }`);
  }
  const encoder = join(dir, 'encoder');
  appendFileSync(join(encoder, 'Cargo.toml'), patches.join('\n') + '\n');
  assert.match(run('cargo', ['test', '--quiet'], { cwd: encoder }), /test result: ok\. [1-9]/);
});

test('each bill of materials lists what its parts need', () => {
  const names = readdirSync(join(dist, 'sbom'));
  assert.ok(names.length >= 5, names.join(', '));
  for (const name of names) {
    const { bomFormat, specVersion, metadata, components, dependencies } = JSON.parse(readFileSync(join(dist, 'sbom', name), 'utf8'));
    assert.deepEqual([bomFormat, specVersion], ['CycloneDX', '1.5']);
    const known = [metadata.component, ...components].map((one) => one['bom-ref']);
    assert.equal(new Set(known).size, known.length, `${name} lists one component twice`);
    assert.ok(components.length > 2, `${name} has ${components.length} components`);
    for (const { ref, dependsOn } of dependencies) for (const one of [ref, ...dependsOn]) assert.ok(known.includes(one), `${name}: ${one}`);
    for (const one of components) assert.ok(one.licenses?.length, `${name}: ${one.purl} has a licence`);
  }
});

test('each part contains the licences of its third-party components', () => {
  const { dir, run } = room('licences');
  const name = 'LICENSE.THIRD-PARTY.txt';
  const unzip = (archive, inner) => {
    run('python3', ['-m', 'zipfile', '-e', archive, 'unzipped']);
    return readFileSync(join(dir, 'unzipped', inner, name), 'utf8');
  };
  const wheel = file('python', WHEEL);
  const info = `${wheel.match(/odkit-[\d.]+/)[0]}.dist-info`;
  const texts = {
    bin: readFileSync(join(dist, 'bin', name), 'utf8'),
    npm: run('tar', ['-xzOf', file('npm', /\.tgz$/), `package/${name}`]),
    python: unzip(wheel, `${info}/licenses`),
    site: readFileSync(join(dist, 'site', name), 'utf8'),
    vscode: unzip(file('vscode', /\.vsix$/), 'extension'),
  };
  for (const [part, text] of Object.entries(texts)) {
    const { components } = JSON.parse(readFileSync(join(dist, 'sbom', `${part}.cdx.json`), 'utf8'));
    // odkit's own crates have no checksum.
    const foreign = components.filter((one) => one.hashes || (one.purl.startsWith('pkg:generic/') && !one.name.startsWith('odkit-')));
    assert.ok(foreign.length > 2, part);
    const missing = foreign.filter((one) => !text.includes(`\n${one.name} ${one.version} (`));
    assert.deepEqual(missing.map((one) => one.purl), [], part);
    for (const block of text.split(/\n={80}\n/).slice(1)) assert.match(block, /^(\S.*\n)+\n[^]*\S{3}/, part);
  }
});

test('no part names a folder of the computer that built it', () => {
  const { dir, run } = room('paths');
  const unpacked = [file('npm', /\.tgz$/), ...readdirSync(join(dist, 'crates')).map((name) => join(dist, 'crates', name))];
  for (const archive of unpacked) run('tar', ['-xzf', archive]);
  const wheels = readdirSync(join(dist, 'python')).filter((name) => name.endsWith('.whl'));
  for (const archive of [...wheels.map((name) => join(dist, 'python', name)), file('vscode', /\.vsix$/)]) run('python3', ['-m', 'zipfile', '-e', archive, basename(archive)]);
  const folders = [`${process.env.CARGO_HOME ?? join(homedir(), '.cargo')}/`, ...['crates/', 'od-m'].map((name) => `${resolve(import.meta.dirname, '../..')}/${name}`)];
  let seen = 0;
  for (const place of [dir, join(dist, 'bin'), join(dist, 'site/playground'), join(dist, 'sbom')]) {
    for (const one of readdirSync(place, { recursive: true, withFileTypes: true }).filter((one) => one.isFile())) {
      const text = readFileSync(join(one.parentPath ?? one.path, one.name), 'latin1');
      for (const folder of folders) assert.ok(!text.includes(folder), `${one.name} names ${folder}`);
      seen += 1;
    }
  }
  assert.ok(seen > 1000, `${seen} files`);
});
