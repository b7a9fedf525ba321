import type { Page } from 'playwright-core';
import { describe, expect, it } from 'vitest';
import { Visits } from './support/visits';

/** The work of drawing, by counts: pictures of a paused scene, passes and draw calls of a picture. */
const visits = new Visits();

const kMostPasses = 12;
const kMostCalls = 40;

/**
 * Animation frames without a draw call, which show that nothing is drawn: at 15 per second, more
 * than half a second, the period of the session's status.
 */
const kFrames = 10;
/** Maximum number of such periods until a page must rest. */
const kAttempts = 20;

declare global {
  interface Window {
    /** The number of draw calls since the page was opened. */
    drawCalls: number;
  }
}

/** Runs in the browser, before the page's own scripts. */
function countCalls(): void {
  window.drawCalls = 0;
  const { prototype } = WebGL2RenderingContext;
  const names = [
    'drawArrays',
    'drawElements',
    'drawArraysInstanced',
    'drawElementsInstanced',
  ] as const;
  for (const name of names) {
    const call = prototype[name] as (...args: unknown[]) => void;
    const counted = function (this: WebGL2RenderingContext, ...args: unknown[]): void {
      ++window.drawCalls;
      call.apply(this, args);
    };
    Object.assign(prototype, { [name]: counted });
  }
}

/** A small page, because its size is not the subject. */
const kLook = {
  viewport: { width: 300, height: 200 },
  deviceScaleFactor: 1,
  before: (page: Page) => page.addInitScript(countCalls),
};

/** Returns whether the page soon stops drawing. */
async function comesToRest(): Promise<boolean> {
  await visits.viewer.until('#view[data-warm="true"]');
  return visits.viewer.page.evaluate(
    async ([frames, attempts]) => {
      for (let attempt = 0; attempt < attempts; ++attempt) {
        const before = window.drawCalls;
        for (let n = 0; n < frames; ++n) await new Promise(requestAnimationFrame);
        if (window.drawCalls === before) return true;
      }
      return false;
    },
    [kFrames, kAttempts] as const,
  );
}

describe('a paused scene is not drawn', () => {
  it.each<[string, string, (page: Page) => Promise<unknown>]>([
    ['at first', '', () => Promise.resolve()],
    ['as a clear liquid, with marks', 'liquid:fluid,arrows:true', () => Promise.resolve()],
    ['after a flight of the camera', '', (page) => page.keyboard.press('6')],
    [
      'while the camera follows a body',
      '',
      async (page) => {
        await page.keyboard.press('c');
        await page.waitForSelector('#photo');
        await page.selectOption('#camera-follow', { label: 'crate' });
      },
    ],
    ['with the tool Tilt', '', (page) => page.keyboard.press('3')],
  ])('%s', async (_, view, act) => {
    await visits.visit('sliding-vat-liquid', { ...kLook, tick: 1, view });
    const { page } = visits.viewer;
    const drawn = await page.evaluate(() => window.drawCalls);
    expect(drawn).toBeGreaterThan(0);
    await act(page);
    expect(await comesToRest()).toBe(true);
  });
});

/** Draws a picture, waits for its figures, and returns passes and draw calls. */
async function work(): Promise<{ passes: number; calls: number }> {
  const { page } = visits.viewer;
  return page.evaluate(async () => {
    const { dataset } = document.getElementById('drawing')!;
    const next = (): Promise<unknown> => new Promise(requestAnimationFrame);
    const before = window.drawCalls;
    window.dispatchEvent(new KeyboardEvent('keydown', { key: '+' })); // moves the camera
    while (window.drawCalls === before) await next();
    for (let n = 0; n < 3; ++n) await next();
    delete dataset.calls;
    while (dataset.calls === undefined) await next();
    return { passes: Number(dataset.passes), calls: Number(dataset.calls) };
  });
}

async function expectWithinLimits(scene: string, view: string): Promise<void> {
  await visits.visit(scene, { ...kLook, tick: 1, view });
  const { passes, calls } = await work();
  expect(passes, scene).toBeGreaterThan(0);
  expect(passes, scene).toBeLessThanOrEqual(kMostPasses);
  expect(calls, scene).toBeGreaterThan(3);
  expect(calls, scene).toBeLessThanOrEqual(kMostCalls);
}

it.each([
  'blood-vessel', // most draw calls
  'flooded-town', // most bodies and appearances
  'wave-tank', // most bodies of liquid
])('draws %s within the limits of passes and draw calls', async (scene) => {
  await expectWithinLimits(scene, 'liquid:fluid');
});

it.each([
  ['brick-wall', 'solids:particles'],
  ['brick-wall', 'solids:skin'],
  ['brick-wall', 'solids:both'],
  ['blood-vessel', 'liquid:fluid,solids:both'],
  ['wave-tank', 'liquid:particles'],
  ['wave-tank', 'liquid:surface'],
])('draws many bodies of %s within the limits, as %s', expectWithinLimits);
