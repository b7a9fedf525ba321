import { afterAll, beforeAll, expect, it } from 'vitest';
import { Observer } from './support/observer';
import { Server } from './support/server';
import { openPage } from './support/shared';
import type { Viewer } from './support/viewer';
import { kInTime } from './support/visits';

/** Curves over time, and the times of a tick's stages. */
const server = new Server();

/** Factor by which the page requests figures more often, so that a test receives several soon. */
const kPace = 5;

/** Runs in the browser, before the page's own scripts. */
function hurry(pace: number): void {
  const begin = window.setInterval.bind(window);
  const begun = (act: () => void, time: number): number => begin(act, time / pace);
  window.setInterval = begun as typeof window.setInterval;
}

let viewer: Viewer;
let observer: Observer;

beforeAll(async () => {
  await server.start();
  observer = await Observer.join(server.url);
  viewer = await openPage(server.url, {
    deviceScaleFactor: 0.5,
    before: (page) => page.addInitScript(hurry, kPace),
  });
  await viewer.untilTick(1);
});
afterAll(async () => {
  observer.leave();
  await viewer.close();
  await server.kill();
});

/** Returns the number of pixels of a chart's line, which have a strong colour. */
async function inked(chart: number): Promise<number> {
  return viewer.page
    .locator('#curves-place .chart canvas')
    .nth(chart)
    .evaluate((canvas: HTMLCanvasElement) => {
      // A thin line between two rows is faint in both.
      const kFaint = 20;
      const { data } = canvas.getContext('2d')!.getImageData(0, 0, canvas.width, canvas.height);
      let count = 0;
      for (let i = 0; i < data.length; i += 4) {
        const strongest = Math.max(data[i]!, data[i + 1]!, data[i + 2]!);
        const weakest = Math.min(data[i]!, data[i + 1]!, data[i + 2]!);
        if (data[i + 3]! > kFaint && strongest - weakest > 70) ++count;
      }
      return count;
    });
}

it('fetches the charting library when the section of curves is opened', async () => {
  const fetched = (): Promise<number> =>
    viewer.page.evaluate(
      () =>
        performance.getEntriesByType('resource').filter(({ name }) => name.includes('chart'))
          .length,
    );
  expect(await fetched()).toBe(0);
  await viewer.page.click('#curves-details > summary');
  await viewer.page.waitForSelector('.chart canvas');
  expect(await fetched()).toBeGreaterThan(0);
});

it('draws a line for each curve, which grows while the session plays', async () => {
  await viewer.page.waitForFunction(() =>
    [...document.querySelectorAll<HTMLElement>('.chart')].every(
      ({ dataset }) => Number(dataset.samples) >= 4,
    ),
  );
  const charts = await viewer.page.locator('.chart').all();
  for (const [n, chart] of charts.entries()) {
    if (await chart.isVisible()) await expect.poll(() => inked(n), kInTime).toBeGreaterThan(60);
  }
});

it('draws energies, momentum and density that the server measures', async () => {
  const { diagnostics } = await observer.request('session.stats', { diagnostics: true });
  expect(diagnostics!.kinetic_energy).toBeGreaterThan(0);
  const titles = await viewer.page.locator('.curve figcaption b').allTextContents();
  expect(titles).toEqual(
    expect.arrayContaining(['Energy', 'Momentum', 'Density error of liquids']),
  );
  const text = await viewer.page.getAttribute('.chart', 'aria-label');
  expect(text).toMatch(/motion [\d.e]+ J/);
});

it('shows the computing time of a tick by stage', async () => {
  await viewer.page.waitForSelector('#stage-bar > i');
  const words = (await viewer.page.textContent('#stage-words')) ?? '';
  expect(words).toMatch(/A tick takes [\d.]+ ms of the 20 ms that it may take, so/);
  const shares = await viewer.page.locator('#stage-list span').allTextContents();
  const sum = shares.reduce((total, text) => total + parseInt(text, 10), 0);
  expect(Math.abs(sum - 100)).toBeLessThanOrEqual(shares.length / 2 + 1); // each is rounded
  expect(viewer.problems).toEqual([]);
});

it('clears the curves for another scene', async () => {
  await observer.request('control.pause', {});
  await observer.request('scene.load', { scene: 'dam-break' });
  // One sample: the figures at the start of the scene.
  await viewer.page.waitForFunction(() =>
    [...document.querySelectorAll<HTMLElement>('.chart')].every(
      ({ dataset }) => Number(dataset.samples) <= 1,
    ),
  );
});
