#!/usr/bin/env node
// wasm-opt, which optimises the same module with the same options only once: it takes half a
// minute, and `cargo xtask test` builds the module for the page and for the npm package.
// ODKIT_TOOLS is the folder with the npm package `binaryen` and with what is kept.
const { spawnSync } = require('node:child_process');
const { createHash } = require('node:crypto');
const fs = require('node:fs');
const path = require('node:path');

/** Modules that are kept. */
const MOST = 6;

const tools = process.env.ODKIT_TOOLS;
const words = process.argv.slice(2);
const to = words.indexOf('-o') + 1;
const from = words.findIndex((word, at) => word.endsWith('.wasm') && at !== to);
const program = path.join(tools, 'node/node_modules/binaryen/bin/wasm-opt');
const run = () => spawnSync(process.execPath, [program, ...words], { stdio: 'inherit' }).status ?? 1;
if (to === 0 || from < 0) process.exit(run());

// In any place: wasm-pack writes the names of the files first.
const options = words.filter((_, at) => at !== from && at !== to && at !== to - 1);
const version = fs.readFileSync(path.join(tools, 'node/package-lock.json'));
const input = fs.readFileSync(words[from]);
const hash = createHash('sha256').update(version).update(options.join(' ')).update('\0').update(input).digest('hex');
const folder = path.join(tools, 'optimised');
const kept = path.join(folder, `${hash}.wasm`);
if (!fs.existsSync(kept)) {
  const status = run();
  if (status !== 0) process.exit(status);
  fs.mkdirSync(folder, { recursive: true });
  // Under its name only when it is whole.
  const part = path.join(folder, `${process.pid}.part`);
  fs.copyFileSync(words[to], part);
  fs.renameSync(part, kept);
  const age = (name) => fs.statSync(path.join(folder, name)).mtimeMs;
  const names = fs.readdirSync(folder).sort((a, b) => age(b) - age(a));
  for (const name of names.slice(MOST)) fs.rmSync(path.join(folder, name), { force: true });
}
fs.copyFileSync(kept, words[to]);
