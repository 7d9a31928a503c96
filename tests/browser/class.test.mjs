// A class: the trainer's page, and two students in browsers of their own, on the program `odkit class`.
import assert from 'node:assert/strict';
import { mkdtemp, rm, writeFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, afterEach, before, test } from 'node:test';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { flawless } from './axe.mjs';
import { becomes, nmt } from './bench.mjs';
import { browser } from './check.mjs';
import { serve } from '../../playground/web/serve.mjs';
import { blank, opened } from './harness.mjs';
import { odkit } from './odkit.mjs';

const PAGE = fileURLToPath(new URL('../../playground/web/dist/', import.meta.url));

/** A lesson of the trainer, in a folder of its own. */
let folder;
const OWN = `+++
title = "Our machine"
level = 1
minutes = 5
+++

An encoder of our machine.

\`\`\`set-up
device gxam node 3
\`\`\`

## Start it

Start node 3.

\`\`\`checkpoint
state operational
\`\`\`

### Predict

Which frame starts it?

\`\`\`answer
000#01 03
\`\`\`

The command is 01h.

### Hint

Send the NMT command *start*.

### What just happened

It runs.

\`\`\`solution
nmt start
\`\`\`
`;

let running;
before(async () => {
  folder = await mkdtemp(join(tmpdir(), 'odkit-class-'));
  await writeFile(join(folder, 'machine.md'), OWN);
});
after(() => rm(folder, { recursive: true, force: true }));
afterEach(() => running?.stop());

const start = async (port) => (running = await odkit(['class', '--host', '127.0.0.1', '--port', String(port), '--page', PAGE, '--lessons', folder], /(http:\S+trainer\.html#\w+)/));

/** Opens an address in a browser profile of its own; `faults` are the errors of the page. */
async function visit(address, context = {}) {
  const page = await blank(browser, context);
  const faults = [];
  opened.set(page, faults);
  await page.goto(address);
  return { page, faults };
}

const introduce = async (page, name) => {
  const dialog = page.getByRole('dialog', { name: 'Welcome to the class' });
  await dialog.getByRole('textbox', { name: 'Your name' }).fill(name);
  await dialog.getByRole('button', { name: 'Join the class' }).click();
  return dialog;
};

test('a trainer sees two students, offers a lesson, sees who is stuck, and empties the class for the next group', async () => {
  const { found: address } = await start(0);
  const site = new URL('/', address);
  const { page: trainer, faults } = await visit(address);
  await trainer.getByText('No student has joined yet.').waitFor();
  assert.equal(new URL(trainer.url()).hash, '', 'the word is not on the projector');
  await trainer.getByText(site.href).waitFor();

  const { page: anna, faults: ofAnna } = await visit(site.href);
  const { page: ben, faults: ofBen } = await visit(site.href);
  await (await introduce(anna, ' Anna  <b>')).waitFor({ state: 'hidden' });
  // A name that is there is refused.
  const dialog = await introduce(ben, 'anna <B>');
  await dialog.getByText('A student with this name is here already.').waitFor();
  await flawless(ben, 'the question for the name', 'dialog[open]');
  await introduce(ben, 'Ben');
  await dialog.waitFor({ state: 'hidden' });
  const row = (name) => trainer.getByRole('row', { name });
  const cell = (name, column) => row(name).locator('td').nth(column).innerText();
  await becomes('both are here', () => trainer.getByRole('status').first().innerText(), '2 of 2 here');
  await becomes('the names', () => trainer.locator('tbody strong').allTextContents(), ['Anna <b>', 'Ben']);

  // A page that reports a lesson of four billion steps leaves the table as it is.
  const say = async (what, body) => (await fetch(new URL(`class/${what}`, site), { method: 'POST', headers: { 'content-type': 'application/json' }, body: JSON.stringify(body) })).json();
  for (const bad of ['E\u001b[2J', 'a\u202eb', ' ', 'x'.repeat(10_000)]) assert.deepEqual(await say('join', { name: bad }), { why: 'name' });
  const { key, group } = await say('join', { name: 'Eve <script>' });
  for (const name of ['nmt', '\u202etmn']) {
    const lesson = { name, step: 1, of: 0xffff_ffff, wrong: 0, hints: 0, shown: 0 };
    assert.deepEqual(await say('report', { key, group, hidden: false, lesson, finished: [name], answered: 0 }), { offer: null });
  }
  await becomes('her place', () => cell('Eve', 0), 'free bench');
  await trainer.getByRole('button', { name: 'Remove Eve <script> from the table' }).click();
  await becomes('the names', () => trainer.locator('tbody strong').allTextContents(), ['Anna <b>', 'Ben']);

  // The trainer's own lesson is the first to offer; Anna opens it, Ben does not.
  await trainer.getByRole('button', { name: 'Offer to all' }).click();
  await anna.getByText('Your trainer offers the lesson “Our machine”.').waitFor();
  await becomes('it waits', () => cell('Anna', 0), 'free bench\noffered: Our machine');
  await anna.getByRole('button', { name: 'Open it' }).click();
  await anna.getByRole('heading', { name: 'Our machine' }).waitFor();
  await ben.getByText('Your trainer offers').waitFor();
  await ben.getByRole('button', { name: 'Not now' }).click();
  await becomes('where Anna is', () => cell('Anna', 0), 'Our machine');
  await becomes('her step', () => cell('Anna', 1), '1 of 1');
  await becomes('Ben has dismissed it', () => cell('Ben', 0), 'free bench');

  // Wrong answers and a hint.
  const answer = anna.locator('.lesson-foot').getByRole('textbox', { name: 'Your frame' });
  for (const wrong of ['001#01 03', '000#02 03', '000#01 04']) {
    await answer.fill(wrong);
    await answer.press('Enter');
    await anna.getByText('Not quite').waitFor();
  }
  await becomes('she is stuck', () => trainer.getByRole('status').first().innerText(), /^2 of 2 here\s+stuck: Anna <b> \(Our machine, 1\)$/);
  await becomes('her answers', () => cell('Anna', 3), '3');
  await flawless(trainer, "the trainer's page", 'body');

  // A reload comes back to the same row, step and bench.
  await anna.reload();
  await anna.getByRole('heading', { name: 'Our machine' }).waitFor();
  await becomes('one row for her', () => trainer.locator('tbody tr').count(), 2);
  await nmt(anna, 'Start');
  await anna.getByText('You did it').waitFor();
  await becomes('she is done', () => cell('Anna', 1), 'done');
  await becomes('one lesson', () => cell('Anna', 5), '1');

  // Only Ben gets the next offer; the program starts again under him.
  await trainer.getByRole('combobox', { name: 'Lesson to offer' }).selectOption('sdo');
  await trainer.getByRole('button', { name: /^Offer “.*” to Ben$/ }).click();
  await ben.getByRole('button', { name: 'Open it' }).click();
  await becomes('where Ben is', () => cell('Ben', 1), /^1 of \d$/);
  assert.equal(await anna.getByText('Your trainer offers').count(), 0);
  await running.stop();
  await trainer.getByText('odkit class does not answer.').waitFor();
  await start(site.port);
  const { page: again } = await visit(running.found);
  await becomes('both report again', async () => (await again.locator('tbody strong').allTextContents()).sort(), ['Anna <b>', 'Ben']);
  await becomes('Ben is where he was', () => again.getByRole('row', { name: 'Ben' }).locator('td').nth(1).innerText(), /^1 of \d$/);

  // The class counts its offers from 1 again. Of two pages of a student, the one that she used last reports; a trainer who
  // reloads has the same choice.
  await again.getByRole('combobox', { name: 'Lesson to offer' }).selectOption('nmt');
  await again.reload();
  await again.getByRole('button', { name: 'Offer to all' }).click();
  for (const page of [anna, ben]) await page.getByText('Your trainer offers the lesson “NMT states and commands”.').waitFor();
  const second = await anna.context().newPage();
  await second.goto(new URL('#lesson=mapping', site).href);
  await becomes('her second page', () => again.getByRole('row', { name: 'Anna' }).locator('td').first().innerText(), /^Mapping/);
  await anna.evaluate(() => window.dispatchEvent(new Event('focus')));
  await becomes('her first page', () => again.getByRole('row', { name: 'Anna' }).locator('td').first().innerText(), /^Our machine/);
  await second.close();

  // The next group: what the pages keep of the class is gone, and what they had before is not.
  await anna.evaluate(() => localStorage.setItem('odkit.progress', '{"nmt":[4,4,"2026-11-26"]}'));
  await again.getByRole('button', { name: 'Next group' }).click();
  await again.getByRole('button', { name: 'Yes, empty it' }).click();
  for (const page of [anna, ben]) {
    await page.getByRole('dialog', { name: 'Welcome to the class' }).waitFor();
    assert.equal(await page.locator('od-lesson').count(), 0);
    assert.deepEqual(await page.evaluate(() => ['odkit.class', 'odkit.class.progress'].map((key) => localStorage.getItem(key))), [null, null]);
  }
  assert.equal(await anna.evaluate(() => localStorage['odkit.progress']), '{"nmt":[4,4,"2026-11-26"]}');
  await again.getByText('No student has joined yet.').waitFor();
  await introduce(anna, 'Carla');
  await becomes('the next group', () => again.locator('tbody strong').allTextContents(), ['Carla']);
  const unreachable = (text) => !/ERR_CONNECTION_REFUSED|40[39]|410/.test(text);
  for (const [of, all] of Object.entries({ faults, ofAnna, ofBen })) assert.deepEqual(all.filter(unreachable), [], of);
  for (const page of [trainer, again, anna, ben]) await page.context().close();
});

test('a trainer sees who is in a fault case or in the final test, and an offer arrives there', async () => {
  const { found: address } = await start(0);
  const { page: trainer, faults } = await visit(address);
  const { page: anna, faults: ofAnna } = await visit(new URL('/', address).href);
  await (await introduce(anna, 'Anna')).waitFor({ state: 'hidden' });
  const cell = (column) => trainer.getByRole('row', { name: 'Anna' }).locator('td').nth(column).innerText();
  await anna.getByRole('button', { name: 'Learn' }).click();
  await anna.getByRole('button', { name: 'Fault cases' }).click();
  await anna.getByRole('button', { name: 'Node 4 does not answer' }).click();
  await becomes('her place', () => cell(0), 'Fault case');
  await anna.locator('od-fault-cases').getByRole('radio').first().check();
  await anna.getByRole('button', { name: 'Check my answer' }).click();
  await becomes('it is marked', () => cell(1), 'done');
  await anna.getByRole('button', { name: 'All lessons' }).click();
  await anna.getByRole('button', { name: 'Begin the final test' }).click();
  await anna.getByRole('button', { name: 'I do not know it' }).click();
  await becomes('the test', () => cell(0), 'Final test');
  await becomes('her question', () => cell(1), '2 of 12');
  await trainer.getByRole('combobox', { name: 'Lesson to offer' }).selectOption('sdo');
  await trainer.getByRole('button', { name: 'Offer to all' }).click();
  const offer = anna.getByRole('dialog', { name: 'Final test' }).getByRole('region', { name: 'Offers' });
  await offer.getByText('Your trainer offers the lesson').waitFor();
  await flawless(anna, 'an offer in a dialog', 'dialog[open]');
  await offer.getByRole('button', { name: 'Open it' }).click();
  await becomes('the lesson', () => cell(0), /^SDO/);
  // The test waits where it was.
  await anna.getByRole('button', { name: 'Learn' }).click();
  await anna.getByRole('button', { name: 'Continue the final test with question 2 of 12' }).click();
  await becomes('the test again', () => cell(1), '2 of 12');
  for (const [of, all] of Object.entries({ faults, ofAnna })) assert.deepEqual(all, [], of);
  for (const page of [trainer, anna]) await page.context().close();
});

test("without the trainer's word or without a class the page says what to open", async () => {
  const { found: address } = await start(0);
  const { page } = await visit(new URL('/trainer.html', address).href);
  await page.getByText('This page needs the trainer’s address').waitFor();
  await page.goto('about:blank');
  await page.goto(new URL('/trainer.html#0000', address).href);
  await page.getByText('This page needs the trainer’s address').waitFor();
  const server = await serve(pathToFileURL(PAGE), 0);
  const { page: alone } = await visit(new URL('trainer.html', server.url).href);
  await alone.getByText('Start “odkit class”').waitFor();
  server.stop();
  for (const one of [page, alone]) await one.context().close();
});
