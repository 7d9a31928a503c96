// Lessons in the page: done by clicks, keys and the send line; and lessons from a file.
import assert from 'node:assert/strict';
import { readdir, readFile } from 'node:fs/promises';
import { test } from 'node:test';
import { becomes, booted, clock, nmt, rows, sdo, sdoNote, sendRaw, state, until } from './bench.mjs';
import { browser, open } from './check.mjs';
import { URL_OF_PAGE } from './harness.mjs';

const folder = new URL('../../playground/lessons/', import.meta.url);
const files = (await readdir(folder)).filter((name) => /^\d+-.*\.md$/.test(name));

const NMT = { start: 'Start', stop: 'Stop', preop: 'Pre-op', reset: 'Reset node' };
const FAULTS = { 'position-error': 'Sensor position' };
const millis = (text) => Number.parseFloat(text) * (text.endsWith('ms') ? 1 : 1000);
const part = (page, name) => page.getByRole('group', { name: 'Encoder views' }).getByRole('button', { name }).click();
const power = (page) => page.getByRole('switch', { name: 'Power' }).click();
const devices = (page) => page.getByRole('group', { name: 'Devices on the bus' }).getByRole('button', { name: /node \d/ });

/** Waits until this much of the bench's time has passed, or a goal has stopped it. */
async function pass(page, milliseconds) {
  const from = await clock(page);
  await until(`${milliseconds} ms to pass`, async () => (await clock(page)) - from >= milliseconds || (await page.getByRole('button', { name: 'Run time' }).isVisible()));
}

/** Does one line of a solution as a user would. */
async function act(page, line, labels) {
  const [word, ...rest] = line.split(/\s+/);
  switch (word) {
    case 'power':
      await power(page);
      if (rest[0] === 'on') return;
      await becomes('the state', () => state(page), 'Off');
      if (rest[0] !== 'cycle') return;
      await pass(page, millis(rest[1] ?? '300ms'));
      return power(page);
    case 'nmt':
      if (rest[1]) return sendRaw(page, `000#${{ start: '01', stop: '02', reset: '81' }[rest[0]]} ${rest[1] === 'all' ? '00' : rest[1].padStart(2, '0')}`);
      return nmt(page, NMT[rest[0]]);
    case 'sdo': {
      const [, kind, object, value] = /^sdo (read|write) (\S+?)(?: = (\S+))?(?: aborts .*)?$/.exec(line);
      await sdo(page, object.replace('h', ''), kind === 'write' ? value : undefined);
      return becomes(`the answer to ${line}`, () => sdoNote(page), /written|=|abort/i);
    }
    case 'fault':
      await part(page, 'Hardware');
      return page.getByRole('button', { name: FAULTS[rest[0]] }).click();
    case 'shaft': {
      await part(page, 'Shaft');
      const shaft = page.getByRole('slider', { name: 'Shaft' });
      for (let degrees = 0; degrees < Number(rest[1]) * 360; degrees += 5) {
        const before = await shaft.getAttribute('aria-valuenow');
        await shaft.press('ArrowRight');
        await until('the shaft to turn', async () => (await shaft.getAttribute('aria-valuenow')) !== before);
      }
      return;
    }
    case 'use':
      return devices(page).nth(labels.indexOf(rest[0])).click();
    case 'switch':
      await part(page, 'Hardware');
      for (const [i, bit] of [4, 2, 1].entries()) {
        const dip = page.getByRole('switch', { name: `DIP ${i + 1}` });
        const wanted = String((Number(rest[1]) & bit) !== 0);
        if ((await dip.getAttribute('aria-checked')) !== wanted) await dip.click();
        await becomes(`DIP ${i + 1}`, () => dip.getAttribute('aria-checked'), wanted);
      }
      return;
    case 'line':
      await part(page, 'Hardware');
      return page.getByRole('button', { name: `${rest[1]} × 120 Ω` }).click();
    case 'wait':
      return pass(page, millis(rest[0]));
    default:
      return sendRaw(page, line);
  }
}

const BY_HAND = ['boot-up-and-heartbeat', 'nmt', 'sdo', 'scaling', 'find-silent-node', 'find-terminator'];
for (const name of BY_HAND) {
  test(`the lesson ${name} is solved by hand`, async () => {
    const text = await readFile(new URL(files.find((file) => file.endsWith(`-${name}.md`)), folder), 'utf8');
    const solutions = [...text.matchAll(/```solution\n([\s\S]*?)```/g)].map(([, lines]) => lines.trim().split('\n'));
    const labels = [...text.matchAll(/^device .* as (\S+)/gm)].map(([, label]) => label);
    const { page, faults, close } = await open({ hash: `#lesson=${name}` });
    const lesson = page.locator('od-lesson');
    const isDone = async () => (await lesson.locator('.happened').count()) === 1;
    for (const [i, lines] of solutions.entries()) {
      await becomes('the step', () => lesson.locator('.lesson-step h3 .num').textContent(), String(i + 1));
      await becomes(`step ${i + 1} is done before anything was done`, isDone, false);
      for (const line of lines) if (!(await isDone())) await act(page, line.trim(), labels);
      await until(`step ${i + 1} of ${name} to be done`, isDone);
      if (i + 1 < solutions.length) await lesson.getByRole('button', { name: 'Continue' }).click();
    }
    await lesson.getByText('You did it').waitFor();
    assert.deepEqual(faults, [], 'the page complained');
    await close();
  });
}

/** Opens all hints, until the solution is offered. */
async function takeHints(lesson) {
  const hint = lesson.getByRole('button', { name: /hint$/ });
  const solution = lesson.getByRole('button', { name: 'Show me' });
  for (let taken = await lesson.locator('.hint').count(); !(await solution.isVisible()); ) {
    await hint.click();
    taken += 1;
    await becomes('hints', () => lesson.locator('.hint').count(), taken);
  }
}

/** Shows all steps of a lesson, and stays at the end of the last one. */
async function showSteps(lesson, count) {
  for (let step = 1; step <= count; step++) {
    await becomes('the step', () => lesson.locator('.lesson-step h3 .num').textContent(), String(step));
    await takeHints(lesson);
    await lesson.getByRole('button', { name: 'Show me' }).click();
    await lesson.getByText('What just happened').waitFor();
    if (step < count) await lesson.getByRole('button', { name: 'Continue' }).click();
  }
}

const nameOf = (file) => file.replace(/^\d+-|\.md$/g, '');
/** `cargo test -p od-tests --test lessons` checks all of them; a long run also clicks through the later ones. */
const BY_CLICKS = files.filter((file) => process.env.ODKIT_LONG || file < '16').map(nameOf).filter((name) => !BY_HAND.includes(name));
for (const name of BY_CLICKS) {
  test(`the lesson ${name} is gone through by clicks, hints first`, async () => {
    const file = files.find((file) => nameOf(file) === name);
    const steps = [...(await readFile(new URL(file, folder), 'utf8')).matchAll(/```solution\n/g)].length;
    const { page, faults, close } = await open({ hash: `#lesson=${name}` });
    const lesson = page.locator('od-lesson');
    for (let step = 1; step <= steps; step++) {
      await becomes('the step', () => lesson.locator('.lesson-step h3 .num').textContent(), String(step));
      await becomes(`step ${step} is done before anything was done`, () => lesson.locator('.happened').count(), 0);
      await takeHints(lesson);
      await lesson.getByRole('button', { name: 'Show me' }).click();
      await becomes(`step ${step} of ${name} is done`, () => lesson.locator('.happened').count(), 1);
      if (step < steps) await lesson.getByRole('button', { name: 'Continue' }).click();
    }
    await lesson.getByText('You did it').waitFor();
    assert.deepEqual(faults, [], 'the page complained');
    await close();
  });
}

test('a lesson is chosen from the list, asks, gives hints one by one, stops time at a goal, and is marked when done', async () => {
  const { page, faults, close } = await open();
  await booted(page);
  await page.getByRole('button', { name: 'Learn' }).click();
  const list = page.getByRole('dialog', { name: 'Lessons' });
  await becomes('all lessons', () => list.locator('[aria-labelledby^=level-]').getByRole('listitem').count(), files.length);
  await list.getByRole('button', { name: /^Find the fault: now and then/ }).click();
  const lesson = page.locator('od-lesson');
  await lesson.getByRole('heading', { level: 3 }).waitFor();
  await becomes('the address', () => page.url(), /#lesson=find-terminator$/);

  await lesson.getByRole('button', { name: 'Other lessons' }).click();
  await list.getByRole('button', { name: /^Boot-up and heartbeat/ }).click();
  await lesson.getByRole('heading', { name: 'Boot-up and heartbeat' }).waitFor();
  const answer = lesson.getByRole('textbox', { name: 'Your frame' });
  await answer.fill('704#00');
  await answer.press('Enter');
  await lesson.getByText('Not quite: look at the CAN-ID again.').waitFor();
  await answer.fill('705#00');
  await answer.press('Enter');
  await lesson.getByText('That is it.').waitFor();

  await lesson.getByRole('button', { name: 'A hint' }).click();
  await becomes('hints', () => lesson.locator('.hint').count(), 1);
  await lesson.getByRole('button', { name: 'Another hint' }).click();
  await becomes('hints', () => lesson.locator('.hint').count(), 2);
  await power(page);
  await lesson.getByText('What just happened').waitFor();
  await page.getByRole('button', { name: 'Run time' }).waitFor();
  const beside = page.getByRole('group', { name: 'Beside the bus' });
  await beside.getByRole('button', { name: 'Objects' }).click();
  await page.getByRole('searchbox', { name: 'Search objects' }).waitFor();
  await beside.getByRole('button', { name: 'Lesson' }).click();
  await lesson.getByRole('button', { name: 'Continue' }).click();
  await page.getByRole('button', { name: 'Pause time' }).waitFor();

  // A condition is ticked as soon as it holds, although others are open: time runs slowly
  // here, so that the heartbeat does not come before the test has looked.
  const speed = page.getByRole('combobox', { name: 'Speed', exact: true });
  await speed.selectOption('0.01');
  await sdo(page, '1017', '500');
  await becomes('requirements ticked', () => lesson.locator('.checks li[data-done=true]').count(), 2);
  assert.equal(await lesson.locator('.happened').count(), 0);
  await speed.selectOption('1');
  await lesson.getByText('What just happened').waitFor();

  // The solution is shown from here on: the hints end.
  for (let step = 3; step <= 5; step++) {
    await lesson.getByRole('button', { name: 'Continue' }).click();
    await becomes('the step', () => lesson.locator('.lesson-step h3 .num').textContent(), String(step));
    await takeHints(lesson);
    await lesson.getByRole('button', { name: 'Show me' }).click();
    await lesson.getByText('What just happened').waitFor();
  }
  await lesson.getByText('You did it').waitFor();
  await lesson.getByRole('button', { name: 'Other lessons' }).last().click();
  await list.getByRole('button', { name: /^Boot-up and heartbeat.*Done/s }).waitFor();
  await list.getByRole('button', { name: 'Close' }).click();
  await lesson.getByRole('button', { name: 'Leave the lesson' }).click();
  await becomes('lessons', () => lesson.count(), 0);
  assert.deepEqual(faults, []);
  await close();
});

const OWN = `+++
title = "A lesson of my own"
level = 1
minutes = 1
+++
Only for this test.

\`\`\`set-up
device gxam node 3
\`\`\`

## Start it

Do it. <b id="markup">Not bold</b>

\`\`\`checkpoint
state operational -- it runs
\`\`\`

### Hint

Use the button.

### What just happened

It runs.

\`\`\`solution
nmt start
\`\`\`
`;

test("a trainer's own lesson is opened from a file; a wrong one says in which line, and leaves the bench", async () => {
  const { page, faults, close } = await open();
  await booted(page);
  await page.getByRole('button', { name: 'Learn' }).click();
  const list = page.getByRole('dialog', { name: 'Lessons' });
  const give = (name, text) => list.getByLabel('Open lessons from files').setInputFiles([name].flat().map((one) => ({ name: one, mimeType: 'text/markdown', buffer: Buffer.from(text) })));

  const bad = OWN.replace('state operational', 'state running');
  const line = bad.split('\n').findIndex((one) => one.includes('state running')) + 1;
  await give('bad.md', bad);
  const faulty = list.getByRole('alert');
  await faulty.getByText('bad.md cannot be opened').waitFor();
  await faulty.getByText(`Line ${line}`, { exact: true }).waitFor();
  await becomes('it says what to do', () => faulty.locator('.help').first().textContent(), /operational/);
  assert.equal(await page.locator('od-lesson').count(), 0);
  await becomes('the bench is as it was', () => devices(page).first().textContent(), /node 1/);

  await give('device.md', OWN.replace('device gxam', 'device nonsense'));
  await faulty.getByText('device.md cannot be opened').waitFor();

  await give('own.md', OWN);
  await page.getByRole('heading', { name: 'A lesson of my own' }).waitFor();
  await becomes('the device of the lesson', () => devices(page).first().textContent(), /node 3/);
  assert.equal(await page.locator('#markup').count(), 0, 'markup in a lesson is text');
  await nmt(page, 'Start');
  await page.getByText('You did it').waitFor();
  await page.getByRole('button', { name: 'Begin again' }).click();
  await page.getByRole('button', { name: 'A hint' }).waitFor();

  // Several files become a group of the list; what is no lesson is left out, and they are there in the next visit.
  await page.getByRole('button', { name: 'Other lessons' }).click();
  const group = list.getByRole('list', { name: 'Your own lessons' });
  await becomes('the lesson of before', async () => (await group.locator('strong').allTextContents()).map((text) => text.trim()), ['A lesson of my own Done']);
  await give(['own.md', 'two.md'], OWN);
  await becomes('two lessons', () => group.getByRole('listitem').count(), 2);
  await give(['README.md', 'NOTES.md'], '# Not a lesson');
  await page.getByText('There is no lesson among these files.').waitFor();
  await give(['bad.md', 'worse.md'], bad);
  await becomes('both are named', () => faulty.locator('h3').allTextContents(), ['bad.md cannot be opened: it has 1 problem.', 'worse.md cannot be opened: it has 1 problem.']);
  await page.goto('about:blank');
  await page.goto(new URL('#lesson=two.md', URL_OF_PAGE).href);
  await page.getByRole('heading', { name: 'A lesson of my own' }).waitFor();
  await page.getByRole('button', { name: 'Other lessons' }).click();
  await list.getByRole('button', { name: 'Remove from this list' }).click();
  await becomes('none', () => group.count(), 0);
  assert.deepEqual(faults, []);
  await close();
});

test('a lesson comes from an address; if it does not exist, an empty bench remains', async () => {
  const context = await browser.newContext({ serviceWorkers: 'block' });
  const page = await context.newPage();
  await page.route('**/course/one.md', (route) => route.fulfill({ body: OWN, contentType: 'text/markdown' }));
  await page.goto(new URL('?lesson=course/one.md', URL_OF_PAGE).href);
  await page.getByRole('heading', { name: 'A lesson of my own' }).waitFor();
  await page.goto(new URL('?lesson=course/two.md', URL_OF_PAGE).href);
  await page.getByText('The lesson course/two.md cannot be opened: 404').waitFor();
  await booted(page);
  await context.close();
});

test('a step whose checks held before it began shows them as already so, and waits for an action of its own', async () => {
  const { page, faults, close } = await open({ hash: '#lesson=scaling' });
  const lesson = page.locator('od-lesson');
  await lesson.getByRole('heading', { level: 3 }).waitFor();
  await sdo(page, '6002', '36000');
  await becomes('the range', () => sdoNote(page), '6002h written');
  await sdo(page, '6001', '3600');
  await lesson.getByRole('button', { name: 'Continue' }).click();
  await lesson.getByText('a range of 36000 (already so)').waitFor();
  await lesson.getByText('Repeat what the step asks for').waitFor();
  assert.equal(await lesson.locator('.happened').count(), 0);
  await sdo(page, '6002', '36000');
  await lesson.locator('.happened').waitFor();
  assert.deepEqual(faults, []);
  await close();
});

test('a check that can no longer hold offers to go back, and "Show me" does so', async () => {
  const { page, faults, close } = await open({ hash: '#lesson=aborts' });
  const lesson = page.locator('od-lesson');
  const step = (number) => becomes('the step', () => lesson.locator('.lesson-step h3 .num').textContent(), String(number));
  for (let number = 1; number <= 4; number++) {
    await step(number);
    await takeHints(lesson);
    await lesson.getByRole('button', { name: 'Show me' }).click();
    await lesson.getByRole('button', { name: 'Continue' }).click();
  }
  await step(5);
  // 1000 with four bytes is valid: 6001h is no longer 8192, which the step requires.
  const spoil = async () => {
    await sdo(page, '6001', '1000');
    await lesson.getByText('A condition held in this step and no longer does').waitFor();
  };
  await spoil();
  await lesson.getByRole('button', { name: 'Begin this step again' }).click();
  await becomes('the condition holds again', () => lesson.locator('.checks li[data-done=true]').count(), 1);
  await step(5);
  await spoil();
  await takeHints(lesson);
  await lesson.getByRole('button', { name: 'Show me' }).click();
  await lesson.getByText('You did it').waitFor();
  assert.deepEqual(faults, []);

  // The progress is a code for a trainer, with the steps that were shown; nothing is sent.
  await lesson.getByRole('button', { name: 'Other lessons' }).last().click();
  await page.getByRole('textbox', { name: 'Your name' }).fill('Ann');
  await becomes('the code', () => page.getByRole('textbox', { name: 'Code' }).inputValue(), /^odkit-progress\/1 learner=Ann aborts=5\/5~5@\d{4}-\d\d-\d\d sum=[0-9A-F]{8}$/);
  await close();
});

test('a wrong answer names its wrong parts and does not print the right ones', async () => {
  const { page, close } = await open({ hash: '#lesson=boot-up-and-heartbeat' });
  const quiz = page.locator('od-quiz');
  const answer = quiz.getByRole('textbox', { name: 'Your frame' });
  for (const wrong of ['704#00', '705#01', '705#', 'zz', '705#00 00']) {
    await answer.fill(wrong);
    await answer.press('Enter');
    await becomes(`an answer to ${wrong}`, () => quiz.locator('[role=status]').textContent(), /./);
    assert.doesNotMatch(`${await quiz.textContent()} ${await answer.getAttribute('placeholder')}`, /705#00/, wrong);
  }
  await close();
});

test('a reload resumes a lesson where it was; the list says how far, and what was shown; the inputs of the last lesson are gone', async () => {
  const { page, faults, close } = await open({ hash: '#lesson=nmt', own: true });
  const lesson = page.locator('od-lesson');
  const stepNumber = () => lesson.locator('.lesson-step h3 .num').textContent();
  await becomes('the step', stepNumber, '1');
  await takeHints(lesson);
  await lesson.getByRole('button', { name: 'Show me' }).click();
  await lesson.getByText('What just happened').waitFor();
  await lesson.getByRole('button', { name: 'Continue' }).click();
  await sendRaw(page, '000#01 00');
  await lesson.getByText('What just happened').waitFor();
  await lesson.getByRole('button', { name: 'Continue' }).click();
  await becomes('the step', stepNumber, '3');
  // A step that is done is stored at once.
  await pass(page, 300);
  await page.reload();
  await becomes('the step after the reload', stepNumber, '3');
  await page.getByRole('heading', { name: 'NMT states and commands' }).waitFor();
  await page.locator('#sdo-object').fill('1018:02');
  await part(page, 'Hardware');
  await lesson.getByRole('button', { name: 'Other lessons' }).first().click();
  const list = page.getByRole('dialog', { name: 'Lessons' });
  await list.getByRole('button', { name: /^NMT states and commands 2 of 4.*1 step shown/s }).waitFor();
  await list.getByRole('heading', { name: /^First steps 0 of \d/ }).waitFor();
  await list.getByRole('button', { name: /^Preset, then save/ }).click();
  await page.getByRole('heading', { name: 'Preset, then save', exact: true }).waitFor();
  await becomes('the object of the last lesson', () => page.locator('#sdo-object').inputValue(), '');
  await becomes('the view of the encoder', () => page.getByRole('group', { name: 'Encoder views' }).getByRole('button', { name: 'Shaft' }).getAttribute('aria-pressed'), 'true');
  // A link to a lesson that was left, while another one runs; and the way back.
  await page.evaluate(() => (location.hash = '#lesson=nmt'));
  await page.getByText('This lesson goes on with step 3 of 4.').waitFor();
  await becomes('the step after the link', stepNumber, '3');
  await page.goBack();
  await page.getByRole('heading', { name: 'Preset, then save', exact: true }).waitFor();
  await becomes('the step after the way back', stepNumber, '1');
  await lesson.getByRole('button', { name: 'Other lessons' }).first().click();
  await list.getByRole('button', { name: /^NMT states and commands 2 of 4/ }).waitFor();
  await becomes('the progress of the other lesson', () => list.getByRole('button', { name: /^Preset, then save \d/ }).count(), 0);
  assert.deepEqual(faults, []);
  await close();
});

test('without storage the lessons open, the list knows the progress of this visit, and another language keeps the step', async () => {
  const { page, faults, close } = await open({ hash: '#', own: true });
  await page.addInitScript(() => {
    const denied = () => {
      throw new DOMException('denied', 'SecurityError');
    };
    for (const name of ['localStorage', 'sessionStorage']) Object.defineProperty(window, name, { get: denied });
    IDBFactory.prototype.open = denied;
  });
  await page.goto(new URL('?#lesson=boot-up-and-heartbeat', URL_OF_PAGE).href);
  const lesson = page.locator('od-lesson');
  await lesson.getByRole('heading', { name: 'Power the encoder' }).waitFor();
  await power(page);
  await lesson.getByText('What just happened').waitFor();
  await lesson.getByRole('button', { name: 'Continue' }).click();
  await page.getByRole('button', { name: 'DE Deutsch' }).click();
  await lesson.getByRole('button', { name: 'Diesen Schritt auf Deutsch neu beginnen' }).click();
  await lesson.getByRole('heading', { name: '2 Stelle einen Heartbeat' }).waitFor();
  await lesson.getByRole('button', { name: 'Andere Lektionen' }).click();
  await page.getByRole('dialog').getByRole('button', { name: /^Boot-up und Heartbeat 1 von 5/ }).waitFor();
  assert.deepEqual(faults, []);
  await close();
});

test('the last lesson of a group offers the first one of the next group', async () => {
  const { page, faults, close } = await open({ hash: '#lesson=preset-then-save' });
  const list = await page.evaluate(async () => {
    const all = await (await fetch('lessons.json')).json();
    const names = all.filter(({ level }) => level === 1).map(({ name }) => name);
    localStorage.setItem('odkit.progress', JSON.stringify(Object.fromEntries(names.map((name) => [name, [1, 1, '2026-01-01']]))));
    return all;
  });
  const lesson = page.locator('od-lesson');
  await lesson.locator('.checks').waitFor();
  await showSteps(lesson, await lesson.locator('.lesson-steps i').count());
  await becomes('the next group', () => lesson.getByRole('button', { name: /^Next: / }).textContent(), `Next: ${list.find(({ level }) => level === 2).title}`);
  assert.deepEqual(faults, []);
  await close();
});

test('a finished lesson offers the next one', async () => {
  const { page, faults, close } = await open({ hash: '#lesson=gear' });
  const lesson = page.locator('od-lesson');
  await showSteps(lesson, 3);
  await lesson.getByRole('button', { name: /^Next: Find the fault: the silent node/ }).click();
  await page.getByRole('heading', { name: 'Find the fault: the silent node' }).waitFor();
  // Before anything is diagnosed, no condition and no row names the cause.
  await becomes('error frames', async () => (await rows(page)).some((one) => one.tag === 'ERR'), true);
  for (const words of [await lesson.innerText(), ...(await rows(page)).map((one) => one.words)]) assert.doesNotMatch(words, /bit rate|250/);
  assert.deepEqual(faults, []);
  await close();
});

test('the last lesson says where the final test is', async () => {
  const { page, faults, close } = await open({ hash: '#lesson=gear' });
  await page.evaluate(async () => {
    const names = (await (await fetch('lessons.json')).json()).map(({ name }) => name).filter((name) => name !== 'gear');
    localStorage.setItem('odkit.progress', JSON.stringify(Object.fromEntries(names.map((name) => [name, [1, 1, '2026-01-01']]))));
  });
  const lesson = page.locator('od-lesson');
  await showSteps(lesson, 3);
  await lesson.getByText('Every lesson is done. The final test is in the list of lessons.').waitFor();
  assert.deepEqual(faults, []);
  await close();
});
