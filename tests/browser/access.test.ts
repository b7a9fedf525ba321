import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { afterAll, describe, expect, it } from 'vitest';
import { cutOff, faults } from './support/faults';
import { Server } from './support/server';
import type { Look } from './support/viewer';
import { kPhone, unfold, Visits } from './support/visits';

/** Accessibility of each part of the page: no serious fault by axe, and no truncated text. */
const data = mkdtempSync(join(tmpdir(), 'vat-access-')); // for a recording
const visits = new Visits(new Server(['--data', data]));
afterAll(() => rmSync(data, { recursive: true }));

// Contrast depends on the theme, truncated text on the size. Each value occurs once.
const kLooks: [string, Look][] = [
  ['light on a desktop', { viewport: { width: 1280, height: 800 }, colorScheme: 'light' }],
  ['dark on a phone', { ...kPhone, colorScheme: 'dark' }],
];

async function expectNoFault(): Promise<void> {
  expect(await faults(visits.viewer)).toEqual([]);
  expect(await cutOff(visits.viewer)).toEqual([]);
}

describe.each(kLooks)('%s', (_, look) => {
  it('sections, all open', async () => {
    await visits.visit('sliding-vat-liquid', { tick: 10, ...look });
    const { page } = visits.viewer;
    await expectNoFault();
    await unfold(visits.viewer, 'curves-details');
    const count = await page.$$eval('#sections > details[id]', (all) => {
      for (const section of all) (section as HTMLDetailsElement).open = true;
      return all.length;
    });
    expect(count).toBeGreaterThan(5);
    await page.waitForSelector('.chart canvas');
    await page.waitForSelector('#bodies li');
    await page.waitForSelector('#material-density');
    await expectNoFault();
  });

  it.each([
    ['keys', '?'],
    ['gallery', 'g'],
    ['share', 'l'],
  ])('dialog %s', async (id, key) => {
    const { page } = visits.viewer;
    await page.keyboard.press(key);
    await page.waitForSelector(`#${id}[open]`);
    await expectNoFault();
    await page.keyboard.press('Escape');
    await page.waitForSelector(`#${id}`, { state: 'hidden' });
  });

  it('menu for camera and pictures', async () => {
    const { page } = visits.viewer;
    await page.keyboard.press('c');
    await page.waitForSelector('#photo');
    await expectNoFault();
    await page.keyboard.press('Escape');
    await page.waitForSelector('#photo', { state: 'hidden' });
  });

  it('colour legend, numbers of a particle, message', async () => {
    const view = 'colour:pressure,clip:y,cells:true,liquid:particles';
    await visits.visit('dam-break', { ...look, tick: 5, view });
    const { viewer } = visits;
    await viewer.until('#colour-legend[data-max]');
    await viewer.clickParticle();
    await viewer.page.setInputFiles('#scene-file-input', {
      name: 'a.json',
      mimeType: 'application/json',
      buffer: Buffer.from('{'),
    });
    await viewer.page.waitForSelector('#notices li');
    await unfold(viewer, 'view-details');
    await expectNoFault();
  });

  it('a body before and after it is placed, and a replay', async () => {
    await visits.visit('rigid-stack', { ...look, tick: 20 });
    const { page } = visits.viewer;
    await unfold(visits.viewer, 'build-details');
    await page.click('#add-place:enabled');
    await expectNoFault();
    await page.keyboard.press('Enter');
    await page.waitForSelector('#build-details li:nth-of-type(7)');
    await expectNoFault();
    await unfold(visits.viewer, 'kept-details');
    await page.click('#recording-watch');
    await page.waitForSelector('#replay:not([hidden])');
    await expectNoFault();
  });
});

it('folds the buttons of many taps', async () => {
  await visits.visit('blood-vessel');
  const { page } = visits.viewer;
  await page.waitForSelector('#pour-row summary');
  const box = await page.locator('#pour-row').boundingBox();
  expect(box!.height).toBeLessThan(100);
  await page.click('#pour-row summary');
  await page.click('#pour-row button[data-emitter="trickle 1"]');
  await page.waitForSelector('#pour-row button[data-emitter="trickle 1"]:has-text("Open")');
  expect(await page.isVisible('#pour-row button[data-emitter="trickle 2"]')).toBe(true);
});
