// Bundles the page into dist/. `--watch` rebuilds on change.
import { build, context } from 'esbuild';
import { createHash } from 'node:crypto';
import { cp, mkdir, readdir, readFile, rm, stat, writeFile } from 'node:fs/promises';
import { inline, policy } from './policy.mjs';

const watch = process.argv.includes('--watch');
const out = new URL('dist/', import.meta.url);
// The page loads the small module first; the whole one is fetched for EDS texts and lessons.
const modules = { 'core.wasm': 'src/wasm/core/od_playground_bg.wasm', 'whole.wasm': 'src/wasm/od_playground_bg.wasm' };

for (const path of Object.values(modules)) {
  if (await stat(new URL(path, import.meta.url)).catch(() => null)) continue;
  console.error(`There is no ${path}: run \`cargo xtask play\`.`);
  process.exit(1);
}

const options = {
  absWorkingDir: new URL('.', import.meta.url).pathname,
  entryPoints: { main: 'src/main.ts', trainer: 'src/class/trainer.ts', worker: 'src/sim/worker.ts', editor: 'src/editor/worker.ts', style: 'src/styles/index.css', dialogs: 'src/styles/dialogs.css', lesson: 'src/styles/lesson.css', editing: 'src/styles/editing.css', seeing: 'src/styles/seeing.css', real: 'src/styles/real.css', machine: 'src/styles/machine.css', labs: 'src/styles/labs.css', cases: 'src/styles/cases.css', 'trainer-style': 'src/styles/trainer.css' },
  outdir: out.pathname,
  bundle: true,
  splitting: true,
  chunkNames: 'part-[hash]',
  format: 'esm',
  target: ['es2022', 'chrome123', 'firefox121', 'safari17.5'],
  minify: !watch,
  sourcemap: watch ? 'inline' : false,
  legalComments: 'none',
  define: { OFFLINE: String(!watch) },
  logLevel: 'warning',
  conditions: watch ? ['development'] : ['production'],
};

await rm(out, { recursive: true, force: true });
await mkdir(out, { recursive: true });
await index();
for (const name of ['icon.svg', 'manifest.webmanifest']) await cp(new URL(`src/${name}`, import.meta.url), new URL(name, out));
for (const [name, path] of Object.entries(modules)) await cp(new URL(path, import.meta.url), new URL(name, out));
await lessons();
await help();
for (const language of ['en', 'de']) await cp(new URL(`../cases/${language}.md`, import.meta.url), new URL(`cases.${language}.md`, out));
if (watch) {
  await (await context(options)).watch();
  console.log('watching');
} else {
  await build(options);
  await serviceWorker();
}

/** The page contains its policy, for servers that send none. On them a lesson may come from another server. So does the page of a trainer. */
async function index() {
  const html = await readFile(new URL('src/index.html', import.meta.url), 'utf8');
  const meta = `<meta http-equiv="Content-Security-Policy" content="${policy(inline(html), "'self' https:")}">`;
  const page = html.replace('<meta charset="utf-8">', `<meta charset="utf-8">\n  ${meta}`);
  await writeFile(new URL('index.html', out), page);
  const trainer = page
    .replaceAll('"main.js"', '"trainer.js"')
    .replace('<link rel="stylesheet" href="style.css">', '$&\n  <link rel="stylesheet" href="trainer-style.css">')
    .replace('<od-app>', '<od-trainer>')
    .replace('</od-app>', '</od-trainer>');
  await writeFile(new URL('trainer.html', out), trainer);
}

/** Each lesson is a file that the page fetches when it is opened, in each language that it has; a list names them all. */
async function lessons() {
  const { initSync, parseLesson, translateLesson } = await import('./src/wasm/od_playground.js');
  initSync({ module: await readFile(new URL(modules['whole.wasm'], import.meta.url)) });
  const translated = (file, text, german) => {
    try {
      return translateLesson(text, german);
    } catch (error) {
      throw new Error(`playground/lessons/de/${file}:${error.message}`);
    }
  };
  const folder = new URL('../lessons/', import.meta.url);
  const list = [];
  const texts = { en: new Map(), de: new Map() };
  for (const file of (await readdir(folder)).filter((name) => /^\d+-.*\.md$/.test(name)).sort()) {
    const text = await readFile(new URL(file, folder), 'utf8');
    const name = file.replace(/^\d+-|\.md$/g, '');
    const one = { name, title: field(text, 'title'), summary: field(text, 'summary'), level: Number(field(text, 'level')), minutes: Number(field(text, 'minutes')) };
    await cp(new URL(file, folder), new URL(`lesson-${name}.md`, out));
    texts.en.set(name, text);
    const german = await readFile(new URL(`de/${file}`, folder), 'utf8').catch(() => null);
    if (german !== null) {
      one.de = { title: field(german, 'title'), summary: field(german, 'summary') };
      texts.de.set(name, translated(file, text, german));
      await writeFile(new URL(`lesson-${name}.de.md`, out), texts.de.get(name));
    }
    list.push(one);
  }
  await writeFile(new URL('lessons.json', out), JSON.stringify(list));
  for (const language of ['en', 'de']) {
    const lesson = (name) => parseLesson(texts[language].get(name) ?? texts.en.get(name)).lesson;
    await writeFile(new URL(`questions.${language}.json`, out), JSON.stringify(await questions(language, lesson)));
  }
}

/** How to write a lesson, for a reader of the page: the guides, and the example in them as a file to begin with. */
async function help() {
  const guides = new URL('../../crates/od-cli/', import.meta.url);
  for (const name of ['LESSONS.md', 'SCRIPTS.md']) await cp(new URL(name, guides), new URL(name, out));
  const [, sample] = /^````markdown\n([^]*?)^````$/m.exec(await readFile(new URL('LESSONS.md', guides), 'utf8'));
  await writeFile(new URL('sample-lesson.md', out), sample);
}

/** The questions of `../questions`, each with title, answer and explanation of its lesson. */
async function questions(language, lessonOf) {
  const text = await readFile(new URL(`../questions/${language}.md`, import.meta.url), 'utf8');
  return [...text.matchAll(/^## (\S+) (\d+)\n+([^]*?)\n*(?=^## |(?![^]))/gm)].map(([, name, step, question]) => {
    const lesson = lessonOf(name);
    const { answer, reveal } = lesson.steps[Number(step) - 1].quiz;
    return { lesson: name, step: Number(step), title: lesson.title, question, answer, reveal };
  });
}

/** A field of the front matter of a lesson. */
function field(text, key) {
  const head = text.split(/^\+\+\+\s*$/m)[1] ?? '';
  return new RegExp(`^${key}\\s*=\\s*"?(.*?)"?\\s*$`, 'm').exec(head)?.[1] ?? '';
}

/** The service worker knows the hash of each file of the page. */
async function serviceWorker() {
  const hash = async (name) => createHash('sha256').update(await readFile(new URL(name, out))).digest('base64url').slice(0, 12);
  const files = await Promise.all((await readdir(out)).sort().map(async (name) => [name, await hash(name)]));
  const text = await readFile(new URL('src/sw.js', import.meta.url), 'utf8');
  await writeFile(new URL('sw.js', out), text.replace('/* FILES */', JSON.stringify(files)));
}
