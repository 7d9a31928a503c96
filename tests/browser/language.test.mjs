// German and English: by the browser, by a link, by the button; lessons in both.
import assert from 'node:assert/strict';
import { flawless } from './axe.mjs';
import { becomes, until } from './bench.mjs';
import { checks } from './check.mjs';
import { URL_OF_PAGE } from './harness.mjs';

const check = checks();
const title = (page, name) => page.getByRole('heading', { name, exact: true });
const inGerman = (page) => title(page, 'Objektverzeichnis').waitFor();
const inEnglish = (page) => title(page, 'Object dictionary').waitFor();
const language = (page) => page.evaluate(() => document.documentElement.lang);

check('a German browser gets the page and a lesson in German, and can change to English', { locale: 'de-DE' }, async (page) => {
  await inGerman(page);
  assert.equal(await language(page), 'de');
  await flawless(page, 'the German page');
  await page.getByRole('button', { name: 'Lernen' }).click();
  await page.getByRole('dialog', { name: 'Lektionen' }).getByRole('button', { name: 'NMT-Zustände und -Kommandos' }).click();
  await title(page, '1 Starte Knoten 5').waitFor();
  const lesson = page.locator('od-lesson');
  assert.equal(await lesson.locator('.lesson').getAttribute('lang'), 'de');
  await lesson.getByText('Knoten 6 ist noch Pre-operational').waitFor();
  await lesson.getByRole('button', { name: 'Ein Tipp' }).click();
  await lesson.getByText('Das erste Byte ist das Kommando, das zweite Byte ist die Node-ID.').waitFor();
  await page.getByRole('button', { name: 'English' }).click();
  await until('the English page', () => lesson.getByText('The text of this lesson is in another language.').isVisible());
  assert.equal(await language(page), 'en');
  await lesson.getByRole('button', { name: 'Begin this step again in English' }).click();
  await title(page, '1 Start node 5').waitFor();
  assert.equal(await lesson.getByText('another language').count(), 0);
  // The choice is kept.
  await page.goto(URL_OF_PAGE);
  await inEnglish(page);
  assert.equal(await language(page), 'en');
});

check('a link chooses the language, which stays', { hash: '?lang=de', own: true }, async (page) => {
  await inGerman(page);
  await becomes('the title', () => page.title(), /odkit/);
  // A language that the page does not have changes nothing.
  await page.goto(new URL('?lang=fr', URL_OF_PAGE).href);
  await inGerman(page);
  // Views that are loaded on request are German, too, and change while they are open.
  await page.getByRole('button', { name: 'Tasten' }).click();
  await title(page, 'Sendezeile').waitFor();
  await page.keyboard.press('Escape');
  await page.getByRole('button', { name: 'Plot', exact: true }).click();
  await page.getByText('Objekt plotten').first().waitFor({ state: 'attached' });
  await page.getByRole('button', { name: 'English' }).click();
  await inEnglish(page);
  await page.getByText('Plot an object').first().waitFor({ state: 'attached' });
});

check('a link to a lesson can name the language', { hash: '#lesson=nmt&lang=de', own: true }, async (page) => {
  await title(page, '1 Starte Knoten 5').waitFor();
});

for (const [device, name] of [['io', 'E/A-Modul (CiA 401)'], ['drive', 'Servoantrieb mit zwei Achsen (CiA 402)']])
  check(`the German page names a virtual device in German: ${device}`, { hash: `#device=${device}&node=4&lang=de`, own: true }, async (page) => {
    await page.locator('.device-title').getByText(name, { exact: true }).waitFor();
  });

check('320 pixels are enough for the German page', { width: 320, height: 700, locale: 'de-DE' }, async (page) => {
  for (const name of ['Encoder', 'Bus', 'Objekte']) {
    await page.getByRole('tab', { name }).click();
    const [inner, outer] = await page.evaluate(() => [document.documentElement.scrollWidth, window.innerWidth]);
    assert.ok(inner <= outer, `${name} is ${inner} pixels wide`);
  }
  // The button is in the list of lessons, where the bar has no room for it.
  await page.getByRole('button', { name: 'Lektionen' }).click();
  await page.getByRole('dialog', { name: 'Lektionen' }).getByRole('button', { name: 'English' }).click();
  await page.getByRole('dialog', { name: 'Lessons' }).waitFor();
});
