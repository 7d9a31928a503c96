// The final test: questions of all lessons without their recipe, a certificate to print, and questions that lessons ask again.
import assert from 'node:assert/strict';
import { readFile } from 'node:fs/promises';
import { flawless } from './axe.mjs';
import { becomes, until } from './bench.mjs';
import { checks } from './check.mjs';
import { URL_OF_PAGE } from './harness.mjs';

const check = checks();

check('the final test fails without answers, passes with ten of twelve, and prints a certificate', async (page) => {
  const all = await (await fetch(new URL('questions.en.json', URL_OF_PAGE))).json();
  await page.getByRole('button', { name: 'Learn' }).click();
  await page.getByRole('button', { name: 'Begin the final test' }).click();
  const test = page.locator('od-final-test');
  const heading = (number) => test.getByRole('heading', { name: `Question ${number} of 12` });
  for (let number = 1; number <= 12; number += 1) {
    await heading(number).waitFor();
    await test.getByRole('button', { name: 'I do not know it' }).click();
  }
  await test.getByText('0 of 12 answers are right. 10 are needed.').waitFor();
  assert.equal(await test.locator('.wrong-answers li').count(), 12);
  await test.getByRole('button', { name: 'Try again' }).click();
  const plain = (text) => text.replaceAll(/\s+/g, ' ').trim();
  const lessons = new Set();
  for (let number = 1; number <= 12; number += 1) {
    await heading(number).waitFor();
    const question = plain(await test.locator('.question').textContent());
    const one = all.find((known) => plain(known.question.replaceAll('`', '')) === question);
    lessons.add(one.lesson);
    if (number === 1) await flawless(page, 'a question', 'dialog[open]');
    const answer = test.getByRole('textbox', { name: 'Your frame' });
    if (number === 1) {
      await answer.press('Enter');
      await test.getByText('Write a frame, or choose “I do not know it”.').waitFor();
      // A text that is not a frame is not an answer.
      await answer.fill('what');
      await answer.press('Enter');
      await test.getByText('This is not a frame.').waitFor();
    }
    await answer.fill(number <= 2 ? '7FF#00' : one.answer.replaceAll('..', '00').replace('*', ''));
    await answer.press('Enter');
  }
  assert.equal(lessons.size, 12, 'each question is from another lesson');
  await test.getByText('10 of 12 answers are right. You have passed.').waitFor();
  assert.equal(await test.locator('.wrong-answers li').count(), 2);
  await test.getByRole('textbox', { name: 'Your name' }).fill('Ann Ü.');
  const certificate = test.getByRole('region', { name: 'Certificate' });
  await becomes('the certificate', () => certificate.innerText(), /Ann Ü\.[^]*10 of 12[^]*odkit-progress\/1 learner=Ann%20%C3%9C\. final-test=10\/12@[^]* sum=/);
  await flawless(page, 'the certificate', 'dialog[open]');
  await page.emulateMedia({ media: 'print' });
  await until('only the certificate on paper', async () => (await certificate.isVisible()) && !(await page.locator('od-topbar').isVisible()) && !(await page.getByText('Answers that were not right').isVisible()));
  await page.emulateMedia({ media: 'screen' });
});

check('a reload and another language keep the final test where it is, and the list offers to continue', { hash: '#lesson=nmt' }, async (page) => {
  await page.locator('od-lesson').getByRole('heading').first().waitFor();
  await page.getByRole('button', { name: 'Learn' }).click();
  await page.getByRole('button', { name: 'Begin the final test' }).click();
  const test = page.locator('od-final-test');
  for (const number of [1, 2]) {
    await test.getByRole('heading', { name: `Question ${number} of 12` }).waitFor();
    await test.getByRole('button', { name: 'I do not know it' }).click();
  }
  await test.getByRole('heading', { name: 'Question 3 of 12' }).waitFor();
  const question = await test.locator('.question').innerText();
  await page.reload();
  await test.getByRole('heading', { name: 'Question 3 of 12' }).waitFor();
  assert.equal(await test.locator('.question').innerText(), question);
  await page.getByRole('dialog').getByRole('button', { name: 'DE Deutsch' }).click();
  await test.getByRole('heading', { name: 'Frage 3 von 12' }).waitFor();
  await becomes('the question in German', async () => (await test.locator('.question').innerText()) !== question, true);
  await page.getByRole('button', { name: 'Zurück zu den Lektionen' }).click();
  await page.getByRole('button', { name: 'Abschlussprüfung mit Frage 3 von 12 fortsetzen' }).click();
  for (let number = 3; number <= 12; number += 1) {
    await test.getByRole('heading', { name: `Frage ${number} von 12` }).waitFor();
    await test.getByRole('button', { name: 'Ich weiß es nicht' }).click();
  }
  await test.getByText('0 von 12 Antworten sind richtig.').waitFor();
  // The result stays until another test begins.
  await page.reload();
  await test.getByText('0 von 12 Antworten sind richtig.').waitFor();
  await test.getByRole('button', { name: 'Noch einmal' }).click();
  await test.getByRole('heading', { name: 'Frage 1 von 12' }).waitFor();
});

check('the sample lesson and the guides are downloads, and the sample is a lesson', async (page) => {
  await page.getByRole('button', { name: 'Learn' }).click();
  const list = page.getByRole('dialog', { name: 'Lessons' });
  const links = list.locator('a[download]');
  const names = [];
  await links.first().waitFor();
  for (const link of await links.all()) {
    const [download] = await Promise.all([page.waitForEvent('download'), link.click()]);
    names.push(download.suggestedFilename());
    const text = await readFile(await download.path(), 'utf8');
    if (names.length === 1) await list.getByLabel('Open lessons from files').setInputFiles({ name: 'sample-lesson.md', mimeType: 'text/markdown', buffer: Buffer.from(text) });
    else assert.match(text, /^# (Lessons|Scripts)$/m);
    if (names.length > 1) continue;
    await page.locator('od-lesson').getByRole('heading', { name: 'Boot-up', exact: true }).waitFor();
    await page.getByRole('button', { name: 'Learn' }).click();
  }
  assert.deepEqual(names, ['sample-lesson.md', 'LESSONS.md', 'SCRIPTS.md']);
});

check('a lesson is printed as a handout, and with its solutions', async (page) => {
  await page.evaluate(() => (window.print = () => {}));
  await page.getByRole('button', { name: 'Learn' }).click();
  await page.getByRole('combobox', { name: 'Print a lesson' }).selectOption('nmt');
  const paper = page.locator('body > .handout');
  for (const [button, hasSolutions] of [['Handout', false], ['With solutions', true]]) {
    await page.getByRole('button', { name: button }).click();
    await becomes('the sheet', () => paper.locator('.about').textContent(), hasSolutions ? /With solutions/ : /min$/);
    assert.equal((await paper.locator('pre').count()) > 0, hasSolutions);
    await page.emulateMedia({ media: 'print' });
    await until('only the sheet on paper', async () => (await paper.isVisible()) && !(await page.locator('od-app').isVisible()));
    await page.emulateMedia({ media: 'screen' });
    assert.equal(await paper.isVisible(), false);
  }
});

check('a lesson asks without the recipe, which can be opened', { hash: '#lesson=nmt' }, async (page) => {
  const quiz = page.locator('od-lesson .lesson-foot od-quiz');
  await becomes('the question', () => quiz.locator('.question').innerText(), 'Which frame starts node 5, and only this node?');
  await quiz.getByText('What you need for it').click();
  await quiz.getByText('Its first byte is the command, 01h for').waitFor();
});

check('a lesson asks a question of one that is done again', async (page) => {
  await page.evaluate(() => localStorage.setItem('odkit.progress', JSON.stringify({ nmt: [4, 4, '2026-11-26'] })));
  // A fresh visit: the one that is left may still write its address.
  await page.goto('about:blank');
  await page.goto(new URL('#lesson=sdo', URL_OF_PAGE).href);
  const again = page.locator('od-lesson .recall');
  await again.getByText('Asked again, from “NMT states and commands”').click();
  const quiz = again.locator('od-quiz');
  await becomes('the question', () => quiz.locator('.question').innerText(), /Which frame (starts|stops) node 5/);
  await quiz.getByRole('button', { name: 'Show the answer' }).click();
  await becomes('the answer', () => quiz.locator('code').first().innerText(), /^000#0[12]/);
});
