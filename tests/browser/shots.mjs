// Makes screenshots for reviews: target/shots/*.png.
import { mkdir } from 'node:fs/promises';
import { launch, open, URL_OF_PAGE } from './harness.mjs';
import { booted, nmt, sdo, sendRaw, until, captured } from './bench.mjs';

const out = new URL('../../target/shots/', import.meta.url);
await mkdir(out, { recursive: true });

const SIZES = [
  { name: 'desktop', width: 1280, height: 800 },
  { name: 'wide', width: 1720, height: 1000 },
  { name: 'phone', width: 390, height: 844, isPhone: true },
];

const browser = await launch();
for (const colorScheme of ['light', 'dark']) {
  for (const { name, width, height, isPhone } of SIZES) {
    const { page, close } = await open(browser, { width, height, colorScheme, deviceScaleFactor: 2, hasTouch: Boolean(isPhone) });
    const shot = async (view) => {
      await page.waitForTimeout(150);
      await page.screenshot({ path: new URL(`${name}-${view}-${colorScheme}.png`, out).pathname });
    };
    const tab = async (text) => isPhone && page.getByRole('tab', { name: text }).click();
    await tab('Bus');
    await booted(page);
    if (name === 'desktop') {
      await page.locator('.device-button').click();
      await shot('devices');
      await page.keyboard.press('Escape');
    }
    await sdo(page, '1018:01');
    await until('the answer', async () => (await captured(page)) >= 3);
    await sdo(page, '6001', '9000');
    await sdo(page, '6001', '4096');
    await until('the answers', async () => (await captured(page)) >= 7);
    await nmt(page, 'Start');
    await sendRaw(page, `601#4004600000000000`);
    await tab('Encoder');
    const rpm = page.getByRole('spinbutton', { name: 'Speed' });
    await rpm.fill('12');
    await rpm.press('Enter');
    await tab('Bus');
    await until('PDOs', async () => (await captured(page)) >= 14);
    if (isPhone) {
      await shot('bus');
      await tab('Encoder');
      await shot('encoder');
      await tab('Objects');
      await page.getByRole('listbox', { name: 'Objects with their live values' }).getByRole('option').nth(9).click();
      await shot('objects');
    } else {
      await page.getByRole('searchbox', { name: 'Search objects' }).fill('60');
      await page.getByRole('listbox', { name: 'Objects with their live values' }).getByRole('option').filter({ hasText: '6004h' }).click();
      await page.getByRole('combobox', { name: 'Object', exact: true }).fill('position');
      await shot('running');
      await page.getByRole('combobox', { name: 'Object', exact: true }).press('Escape');
      await page.getByRole('searchbox', { name: 'Search objects' }).fill('');
      await shot('bench');
    }
    if (colorScheme === 'light') {
      await page.goto(new URL('#device=eam_mt&node=1', URL_OF_PAGE).href);
      await page.reload();
      await tab('Objects');
      await page.getByRole('button', { name: 'PDO mapping' }).click();
      const add = page.getByRole('combobox', { name: 'Add an object' });
      await add.selectOption(await add.locator('option').filter({ hasText: /^6030h/ }).getAttribute('value'));
      await page.getByRole('button', { name: /^Send 4/ }).click();
      await page.getByText('✓').nth(3).waitFor();
      await shot('mapping');
      await page.keyboard.press('Escape');
      await page.getByRole('button', { name: 'Share and save' }).click();
      await until('a link', () => page.getByRole('textbox', { name: 'Link' }).inputValue());
      await shot('share');
    }
    await close();
  }
}
await browser.close();
