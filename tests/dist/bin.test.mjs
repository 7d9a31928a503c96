// The command line for each system: it checks a file, simulates a device, and answers on a link.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { chmodSync, copyFileSync, readFileSync, writeFileSync } from 'node:fs';
import { connect } from 'node:net';
import { join } from 'node:path';
import { createInterface } from 'node:readline';
import { test } from 'node:test';
import { file, has, room } from './room.mjs';

const SCRIPT = 'device gxmm node 1\nexpect 701#00\n601#4000100000000000\nexpect 581#4300100096010200\n';

/** Puts the program of a system into an empty folder. */
function install(name, pattern, as = 'odkit') {
  const own = room(name);
  const odkit = join(own.dir, as);
  copyFileSync(file('bin', pattern), odkit);
  chmodSync(odkit, 0o755);
  return { ...own, odkit };
}

/** The processor of a program for Linux, which must not need a library of the system: no segment names a loader. */
function processor(path) {
  const elf = readFileSync(path);
  const [start, size, number] = [Number(elf.readBigUInt64LE(32)), elf.readUInt16LE(54), elf.readUInt16LE(56)];
  const kinds = Array.from({ length: number }, (_, index) => elf.readUInt32LE(start + index * size));
  assert.ok(kinds.includes(1) && !kinds.includes(3), `${path} is static`);
  return { 62: 'x86-64', 183: 'ARM64' }[elf.readUInt16LE(18)];
}

/** What every system's program does; `run` starts it. */
function works(dir, run) {
  assert.match(run(['--version']), /^odkit \d+\.\d+\.\d+/);
  run(['export', 'gxmm', '-o', 'good.eds']);
  assert.match(run(['check', 'good.eds']), /nothing to report/);
  const text = readFileSync(join(dir, 'good.eds'), 'latin1');
  writeFileSync(join(dir, 'bad.eds'), text.replace(/^DataType=0x0007/m, 'DataType=0x0099'), 'latin1');
  assert.match(run(['check', 'bad.eds'], { status: 1 }), /0x0099/);
  writeFileSync(join(dir, 'good.script'), SCRIPT);
  run(['run', 'good.script']);
  writeFileSync(join(dir, 'bad.script'), SCRIPT.replace('96010200', '00000000'));
  assert.match(run(['run', 'bad.script'], { status: 1 }), /96 ?01 ?02/);
}

/** Starts a simulation and talks to it over slcan, and with a second program. */
async function serves({ dir, env, run }, program, before = []) {
  const args = [...before, 'sim', 'good.eds', '--node-id', '5', '--link', 'slcan:127.0.0.1:0', '--quiet', '--ready-file', '-'];
  const sim = spawn(program, args, { cwd: dir, env, stdio: ['ignore', 'pipe', 'inherit'] });
  try {
    const [line] = await once(createInterface(sim.stdout), 'line');
    const [{ address }] = JSON.parse(line).links;
    const [host, port] = address.split(':');
    const socket = connect(Number(port), host);
    let came = '';
    socket.setEncoding('latin1').on('data', (text) => (came += text));
    socket.write('S6\rO\rt60584000100000000000\r');
    while (!came.includes('t58584300100096010200\r')) await once(socket, 'data');
    socket.destroy();
    assert.match(run(program, [...before, 'get', '5', '1000h', '--link', `slcan:${address}`]), /20196h/);
  } finally {
    sim.kill('SIGKILL');
  }
}

test('Linux on x86-64', async () => {
  const own = install('linux', /x86_64-unknown-linux-musl$/);
  assert.equal(processor(own.odkit), 'x86-64');
  works(own.dir, (args, options) => own.run(own.odkit, args, options));
  await serves(own, own.odkit);
});

test('Linux on ARM64 is static', () => assert.equal(processor(install('static', /aarch64-unknown-linux-musl$/).odkit), 'ARM64'));

test('Linux on ARM64', { skip: has('qemu-aarch64-static') ? false : 'no qemu-user-static' }, async () => {
  const own = install('arm', /aarch64-unknown-linux-musl$/);
  const qemu = (args, options) => own.run('qemu-aarch64-static', [own.odkit, ...args], options);
  works(own.dir, qemu);
  await serves(own, 'qemu-aarch64-static', [own.odkit]);
});

test('Windows on x86-64', { skip: has('wine') ? false : 'no Wine' }, async () => {
  const own = install('windows', /x86_64-pc-windows-gnu\.exe$/, 'odkit.exe');
  assert.doesNotMatch(readFileSync(own.odkit, 'latin1'), /libgcc_s|libwinpthread-1\.dll/, 'it needs no library of its compiler');
  own.env.WINEDEBUG = '-all';
  own.env.WINEPREFIX = join(own.dir, '.wine');
  const stub = new URL('bcryptprimitives.c', import.meta.url).pathname;
  own.run('x86_64-w64-mingw32-gcc', ['-shared', '-o', 'bcryptprimitives.dll', stub, '-ladvapi32']);
  own.run('wine', ['wineboot', '--init']);
  works(own.dir, (args, options) => own.run('wine', [own.odkit, ...args], options));
  await serves(own, 'wine', [own.odkit]);
  own.run('wine', ['wineboot', '--kill']);
});
