import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { afterAll, describe, expect, it } from 'vitest';
import { cutOff, faults } from './faults';
import { Server } from './server';
import type { Look } from './viewer';
import { kPhone, Visits } from './visits';

/** Each part of the page can be seen, read and used by all: axe finds nothing, no word is cut off. */
const data = mkdtempSync(join(tmpdir(), 'vat-access-')); // for a recording to show
const visits = new Visits(new Server(['--data', data]));
afterAll(() => rmSync(data, { recursive: true }));
const kDesktop: Look = { viewport: { width: 1280, height: 800 } };

// Contrast depends on the theme, what is cut off on the size: each is seen once with either.
const looks = [
  ['light', 'desktop', { ...kDesktop, colorScheme: 'light' }],
  ['dark', 'phone', { ...kPhone, colorScheme: 'dark' }],
] as const;

async function expectNoFault(): Promise<void> {
  expect(await faults(visits.viewer)).toEqual([]);
  expect(await cutOff(visits.viewer)).toEqual([]);
}

/** Opens one section of the panel, which on a phone is a sheet that opens first. */
async function unfold(id: string): Promise<void> {
  const { page } = visits.viewer;
  const sheet = page.locator('#sheet[aria-expanded="false"]');
  if (await sheet.isVisible()) await sheet.click();
  await page.locator('#sections > details').evaluateAll((all, open) => {
    for (const section of all as HTMLDetailsElement[]) section.open = section.id === open;
  }, id);
}

describe.each(looks)('in %s on a %s', (_theme, _size, look) => {
  it('each section', async () => {
    await visits.visit('sliding-vat-liquid', { tick: 10, ...look });
    const { page } = visits.viewer;
    await expectNoFault();
    const sections = await page.$$eval('#sections > details[id]', (all) => all.map(({ id }) => id));
    expect(sections.length).toBeGreaterThan(5);
    for (const id of sections) {
      await unfold(id);
      if (id === 'curves-details') await page.waitForSelector('.chart canvas');
      await expectNoFault();
    }
  });

  it('each dialog', async () => {
    await visits.visit('dam-break', look);
    const { page } = visits.viewer;
    for (const id of ['keys', 'gallery', 'share']) {
      await page.keyboard.press({ keys: '?', gallery: 'g', share: 'l' }[id]!);
      await page.waitForSelector(`#${id}[open]`);
      await expectNoFault();
      await page.keyboard.press('Escape');
      await page.waitForSelector(`#${id}`, { state: 'hidden' });
    }
  });

  it('the colours of numbers, and what a click tells', async () => {
    await visits.visit('dam-break', {
      ...look,
      tick: 5,
      hash: '#view=colour:pressure,clip:y,cells:true,liquid:particles',
    });
    const { viewer } = visits;
    await viewer.until('#colour-legend[data-max]');
    const { x, y } = await viewer.findParticle();
    await viewer.page.mouse.click(x, y);
    await viewer.page.waitForSelector('#inspector:not([hidden])');
    await unfold('view-details');
    await expectNoFault();
  });

  it('a body that is placed', async () => {
    await visits.visit('rigid-stack', look);
    const { page } = visits.viewer;
    await unfold('build-details');
    await page.click('#add-place');
    await expectNoFault();
    await page.keyboard.press('Enter');
    await page.waitForSelector('#build-details li:nth-of-type(7)');
    await expectNoFault();
  });

  it('a replay', async () => {
    await visits.visit('rigid-stack', { ...look, tick: 20 });
    const { page } = visits.viewer;
    await unfold('kept-details');
    await page.click('#recording-watch');
    await page.waitForSelector('#replay:not([hidden])');
    await expectNoFault();
  });

  it('messages', async () => {
    await visits.visit('rigid-stack', look);
    const { page } = visits.viewer;
    const file = { name: 'a.json', mimeType: 'application/json', buffer: Buffer.from('{') };
    await page.setInputFiles('#scene-file-input', file);
    await page.waitForSelector('#notices li');
    await expectNoFault();
  });
});

it('has no more buttons for taps than there is room for', async () => {
  await visits.visit('blood-vessel', kDesktop);
  const { page } = visits.viewer;
  await page.waitForSelector('#pour-row summary');
  const box = await page.locator('#pour-row').boundingBox();
  expect(box!.height).toBeLessThan(100);
  await page.click('#pour-row summary');
  await page.click('#pour-row button[data-emitter="trickle 1"]');
  await page.waitForSelector('#pour-row button[data-emitter="trickle 1"]:has-text("Open")');
  expect(await page.isVisible('#pour-row button[data-emitter="trickle 2"]')).toBe(true);
});

it('keeps the way to close the sheet on a phone in sight', async () => {
  await visits.visit('rigid-stack', kPhone);
  const { page } = visits.viewer;
  await unfold('parameters-details');
  const panel = page.locator('#panel');
  await panel.evaluate((sheet) => sheet.scrollTo(0, sheet.scrollHeight));
  const top = (await panel.boundingBox())!.y;
  expect((await page.locator('#sheet').boundingBox())!.y).toBeGreaterThanOrEqual(top);
  await page.tap('#sheet');
  await page.waitForSelector('#sheet[aria-expanded="false"]');
});
