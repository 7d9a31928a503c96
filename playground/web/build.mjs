// Bundles the page into dist/. `--mock` uses the stand-in bus of src/sim/mock.ts
// (for work on the page without a Rust toolchain), `--watch` rebuilds on change.
import { build, context } from 'esbuild';
import { cp, mkdir, rm, stat } from 'node:fs/promises';

const mock = process.argv.includes('--mock');
const watch = process.argv.includes('--watch');
const out = new URL('dist/', import.meta.url);
const wasm = new URL('src/wasm/od_playground_bg.wasm', import.meta.url);

const haveWasm = await stat(wasm).then(() => true, () => false);
if (!mock && !haveWasm) {
  console.error('src/wasm/ is empty: run `cargo xtask play`, or `npm run build -- --mock`.');
  process.exit(1);
}

const options = {
  absWorkingDir: new URL('.', import.meta.url).pathname,
  entryPoints: { main: 'src/main.ts', worker: mock ? 'src/sim/worker-mock.ts' : 'src/sim/worker.ts', style: 'src/styles/index.css' },
  outdir: out.pathname,
  bundle: true,
  format: 'esm',
  target: ['es2022', 'chrome123', 'firefox121', 'safari17.5'],
  minify: !watch,
  sourcemap: watch ? 'inline' : false,
  legalComments: 'none',
  logLevel: 'warning',
  conditions: watch ? ['development'] : ['production'],
  define: { __MOCK__: String(mock) },
};

await rm(out, { recursive: true, force: true });
await mkdir(out, { recursive: true });
await cp(new URL('src/index.html', import.meta.url), new URL('index.html', out));
await cp(new URL('src/icon.svg', import.meta.url), new URL('icon.svg', out));
if (!mock) await cp(wasm, new URL('od_playground_bg.wasm', out));
if (watch) {
  await (await context(options)).watch();
  console.log('watching');
} else {
  await build(options);
}
