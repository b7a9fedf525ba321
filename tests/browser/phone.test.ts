import { expect, it } from 'vitest';
import { kInTime, kPhone, says, unfold, Visits } from './support/visits';

/** The page on a phone: the sheet with the controls, and the sensors. */
const visits = new Visits();

it('reserves space for the picture beside the sheet, whose forms have the width of the page', async () => {
  await visits.visit('sliding-vat-liquid', kPhone);
  const { page } = visits.viewer;
  const height = async (): Promise<number> => (await page.locator('#view').boundingBox())!.height;
  expect(await height()).toBeGreaterThan(480);
  await page.tap('#sheet');
  await page.waitForSelector('#scene', { state: 'visible' });
  expect(await height()).toBeGreaterThan(250);
  await page.tap('#parameters-details > summary');
  for (const id of ['#material-density', '#contact-law', '#integrator', '#steps']) {
    await page.locator(id).scrollIntoViewIfNeeded();
    const box = (await page.locator(id).boundingBox())!;
    expect(box.x).toBeGreaterThanOrEqual(0);
    expect(box.x + box.width).toBeLessThanOrEqual(kPhone.viewport!.width);
  }
  expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBe(390);
  // The button that closes the sheet stays visible.
  const panel = page.locator('#panel');
  await panel.evaluate((sheet) => sheet.scrollTo(0, sheet.scrollHeight));
  const top = (await panel.boundingBox())!.y;
  expect((await page.locator('#sheet').boundingBox())!.y).toBeGreaterThanOrEqual(top);
  await page.tap('#sheet');
  await page.waitForSelector('#sheet[aria-expanded="false"]');
});

it('tilts gravity as the device is tilted, relative to how it was held first', async () => {
  await visits.visit('dam-break', kPhone);
  const { page } = visits.viewer;
  await page.context().grantPermissions(['accelerometer', 'gyroscope']);
  await unfold(visits.viewer, 'parameters-details');
  await page.click('#gravity-device');
  // This machine has no orientation sensor.
  await says(visits.viewer, 'notices', 'does not report its orientation');
  // Immediately, before the page's timeout for a sensor.
  await page.evaluate(async () => {
    const button = document.getElementById('gravity-device') as HTMLButtonElement;
    button.click();
    while (button.ariaPressed !== 'true') await new Promise(requestAnimationFrame);
    for (const gamma of [0, 30]) {
      window.dispatchEvent(new DeviceOrientationEvent('deviceorientation', { beta: 40, gamma }));
    }
  });
  const gravity = async (): Promise<number[]> =>
    (await visits.observer.request('session.join', {})).description.gravity;
  // 30 degrees to the right of the picture, so half of gravity acts to the right.
  await expect
    .poll(async () => Math.hypot(...(await gravity()).slice(0, 2)), kInTime)
    .toBeGreaterThan(4.5);
  const [x, y, z] = await gravity();
  expect(Math.hypot(x!, y!, z!)).toBeCloseTo(9.81, 1);
  expect(x!).toBeGreaterThan(Math.abs(y!)); // the initial view has x to the right
  await page.click('#gravity-device');
  await page.evaluate(() => {
    window.dispatchEvent(new DeviceOrientationEvent('deviceorientation', { beta: 40, gamma: -30 }));
  });
  await page.click('#gravity-reset');
  await expect.poll(gravity, kInTime).toEqual([0, 0, -9.81]);
});
