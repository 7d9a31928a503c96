// Bundles src/**/*.test.ts and runs them with Node's test runner.
import { spawnSync } from 'node:child_process';
import { mkdtemp, readdir, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { build } from 'esbuild';

const here = new URL('.', import.meta.url).pathname;
const names = (await readdir(join(here, 'src'), { recursive: true })).filter((name) => name.endsWith('.test.ts'));
const out = await mkdtemp(join(tmpdir(), 'odkit-page-'));
try {
  await build({
    absWorkingDir: here,
    entryPoints: names.map((name) => join('src', name)),
    outbase: 'src',
    outdir: out,
    bundle: true,
    format: 'esm',
    platform: 'node',
    outExtension: { '.js': '.mjs' },
    logLevel: 'warning',
  });
  // From Node.js 22 on, `--test` with a folder does not mean the files in it.
  const files = names.map((name) => join(out, name.replace(/\.ts$/, '.mjs')));
  process.exitCode = spawnSync(process.execPath, ['--test', ...files], { stdio: 'inherit' }).status ?? 1;
} finally {
  await rm(out, { recursive: true, force: true });
}
