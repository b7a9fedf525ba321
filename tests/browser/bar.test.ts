import { expect, it } from 'vitest';
import { kInTime, Visits } from './support/visits';

/** The slim bar over the picture at the first visit, and the panel that it extends to. */
const visits = new Visits();

const kFresh = { viewport: { width: 1000, height: 640 }, hasBar: true };

const widthOf = async (id: string): Promise<number> =>
  (await visits.viewer.page.locator(id).boundingBox())!.width;

it('shows the picture on the whole page, with one slim bar', async () => {
  await visits.visit('rigid-stack', kFresh);
  const { page } = visits.viewer;
  expect(await widthOf('#view')).toBe(1000);
  const bar = (await page.locator('#panel').boundingBox())!;
  expect(bar.height).toBeLessThan(64);
  expect(bar.x).toBeGreaterThanOrEqual(0);
  expect(bar.x + bar.width).toBeLessThanOrEqual(1000);
  for (const id of ['#play', '#step', '#reset', '#scene', '#gallery-open', '#sheet']) {
    const box = (await page.locator(id).boundingBox())!;
    expect(box.x, id).toBeGreaterThanOrEqual(bar.x);
    expect(box.x + box.width, id).toBeLessThanOrEqual(bar.x + bar.width);
  }
  expect(await page.isVisible('#sections')).toBe(false);
});

it('shows the levels of the scene with their speeds, and loads the chosen one', async () => {
  await visits.visit('rigid-stack', kFresh);
  const { page } = visits.viewer;
  await page.waitForSelector('#level:enabled');
  const bar = (await page.locator('#panel').boundingBox())!;
  const box = (await page.locator('#level').boundingBox())!;
  expect(bar.x + bar.width).toBeLessThanOrEqual(1000);
  expect(box.x + box.width).toBeLessThanOrEqual(bar.x + bar.width);
  const texts = await page.locator('#level option').allTextContents();
  const names = texts.map((text) => /(\w+) · [\d.]+×$/.exec(text)?.[1]);
  expect(names).toEqual(['coarse', 'normal', 'fine', 'finest']);
  expect(texts.filter((text) => text.startsWith('✓ '))).toHaveLength(1);
  const levelOf = async () => (await visits.observer.request('session.join', {})).description.level;
  expect(await page.locator('#level').inputValue()).toBe('normal');
  await page.selectOption('#level', 'coarse');
  await expect.poll(levelOf, kInTime).toBe('coarse');
  expect(await page.locator('#level').inputValue()).toBe('coarse');
});

it('extends to the panel by one click, also at the next visit', async () => {
  await visits.visit('rigid-stack', kFresh);
  const { page } = visits.viewer;
  await page.click('#sheet');
  await page.waitForSelector('#view-details > summary', { state: 'visible' });
  expect(await widthOf('#view')).toBe(660);
  await page.reload();
  await page.waitForSelector('#sheet[aria-expanded="true"]');
  expect(await page.isVisible('#sections')).toBe(true);
  await page.click('#sheet');
  await page.waitForSelector('#sections', { state: 'hidden' });
  expect(await widthOf('#view')).toBe(1000);
});

it.each([
  ['rigid-stack', 770],
  ['pour', 770],
  ['blood-vessel', 930], // many taps
  ['pour', 1130],
])('has no controls beyond its edges, for %s on a page of %d px', async (scene, edge) => {
  await visits.visit(scene, { ...kFresh, viewport: { width: edge, height: 600 } });
  if (scene !== 'rigid-stack') await visits.viewer.page.waitForSelector('#pour');
  const { page } = visits.viewer;
  const boxes = await page
    .locator('#panel :is(button, select, input):not(.taps *)')
    .evaluateAll((all) => all.map((one) => one.getBoundingClientRect().toJSON() as DOMRect));
  const shown = boxes.filter(({ width }) => width > 0).sort((a, b) => a.x - b.x);
  expect(shown.length).toBeGreaterThan(6);
  shown.forEach(({ x, width }, i) => {
    expect(x + width).toBeLessThanOrEqual(shown[i + 1]?.x ?? edge); // nor over one another
  });
});
