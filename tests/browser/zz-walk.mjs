import { launch, open } from './harness.mjs';
const browser = await launch();
const SIZES = [[1920,1080],[1366,625],[1280,800],[1024,768],[640,400],[390,844]];
const only = process.argv[2];
for (const [width,height] of SIZES) {
  const shot = async (page, name) => { await page.waitForTimeout(400); await page.screenshot({ path: `/tmp/c-shots/${name}-${width}x${height}.png` }); };
  if (!only || only === 'labs') {
    const { page, close } = await open(browser, { width, height, hash: '#lesson=bus-length' });
    await page.locator('od-lesson h2, od-lesson h3').first().waitFor();
    await page.waitForTimeout(1500);
    await shot(page, 'lab-line');
    await close();
    const b = await open(browser, { width, height, hash: '#lesson=master' });
    await b.page.locator('od-lesson h2, od-lesson h3').first().waitFor();
    await b.page.waitForTimeout(1500);
    await shot(b.page, 'lab-master');
    await b.close();
    const c = await open(browser, { width, height });
    await c.page.locator('.topbar').waitFor();
    await c.page.waitForTimeout(1500);
    if (width >= 1000) {
      await c.page.getByRole('button', { name: 'Learn' }).click();
      await c.page.getByRole('dialog', { name: 'Lessons' }).getByRole('button', { name: /^Line/ }).click();
      await c.page.locator('.floating-lab').waitFor();
      await shot(c.page, 'lab-floating');
    } else await shot(c.page, 'bench');
    await c.close();
  }
}
await browser.close();
