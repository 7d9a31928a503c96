// A copy of the release, and an empty folder for each test, from which no checkout can be reached.
import { spawnSync } from 'node:child_process';
import { cpSync, existsSync, mkdirSync, mkdtempSync, readdirSync, realpathSync, rmSync, symlinkSync } from 'node:fs';
import { homedir, tmpdir } from 'node:os';
import { join } from 'node:path';
import { after } from 'node:test';

const given = process.env.ODKIT_DIST;
if (!given) throw new Error('ODKIT_DIST names no release: `cargo xtask test --only dist`');

const root = realpathSync(mkdtempSync(join(tmpdir(), 'odkit-dist-')));
after(() => rmSync(root, { recursive: true, force: true }));

/** The release. */
export const dist = join(root, 'dist');
cpSync(given, dist, { recursive: true });

/** The only file of a part with a matching name. */
export function file(part, pattern) {
  const found = readdirSync(join(dist, part)).filter((name) => pattern.test(name));
  if (found.length !== 1) throw new Error(`${part} has ${found.length} files for ${pattern}`);
  return join(dist, part, found[0]);
}

/** An empty folder with a home directory; `run` runs a program in it and returns its output. */
export function room(name) {
  const dir = join(root, name);
  const home = join(dir, '.home');
  const cargo = join(home, '.cargo');
  mkdirSync(cargo, { recursive: true });
  // Downloads are cached; the cache contains nothing of the checkout.
  const registry = join(process.env.CARGO_HOME ?? join(homedir(), '.cargo'), 'registry');
  if (existsSync(registry)) symlinkSync(registry, join(cargo, 'registry'));
  const kept = ['PATH', 'LANG', 'PIP_CERT', 'SSL_CERT_FILE', 'RUSTUP_TOOLCHAIN'];
  const env = { ...Object.fromEntries(kept.flatMap((key) => (process.env[key] ? [[key, process.env[key]]] : []))), HOME: home, CARGO_HOME: cargo };
  env.RUSTUP_HOME = process.env.RUSTUP_HOME ?? join(homedir(), '.rustup');
  env.CARGO_INCREMENTAL = '0';
  env.CARGO_PROFILE_DEV_DEBUG = '0';
  const run = (program, args = [], { status = 0, ...options } = {}) => {
    const done = spawnSync(program, args, { cwd: dir, env, encoding: 'utf8', maxBuffer: 1 << 28, ...options });
    if (done.status === status) return done.stdout + done.stderr;
    throw new Error(`${program} ${args.join(' ')} ended with ${done.status ?? done.signal ?? done.error}, not ${status}:\n${done.stdout}${done.stderr}`);
  };
  return { dir, env, run };
}

/** Returns whether a program of this name exists. */
export const has = (program) => spawnSync('which', [program]).status === 0;
