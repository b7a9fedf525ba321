import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { expect, it } from 'vitest';
import type { Scene } from '../../web/client/index';
import { Server } from './support/server';
import { Visits } from './support/visits';

/**
 * The work of the page's thread for many particles, by counts: the number of times that V8 ran each
 * block of the page's scripts. Times would depend on the load of the machine.
 */
const visits = new Visits(new Server(['--max-particle-steps-per-tick', '10000000']));

const kSpacing = 0.02;
const kParticles = 16_000;
const kPictures = 6;

/**
 * Maximum runs of one block per picture. Loops over bodies, meshes and uniforms are below it, loops
 * over particles are not.
 */
const kMostRuns = kParticles / 16;

/** Three coordinates and a value per particle, twice. */
const kMostBytes = 2 * 12;

/** The dam break with more particles. */
function damBreak(): Scene {
  const path = new URL('../../protocol/scenes/dam-break.json', import.meta.url);
  const scene = JSON.parse(readFileSync(fileURLToPath(path), 'utf8')) as Scene;
  const [body] = scene.bodies ?? [];
  const [material] = scene.materials ?? [];
  if (!body || !material?.liquid || !scene.numerics) throw new Error('the dam break has changed');
  Object.assign(body, { spacing: kSpacing });
  Object.assign(material.liquid, { support_radius: 2 * kSpacing });
  Object.assign(scene.numerics, { step: (0.0025 * kSpacing) / 0.04 });
  return { ...scene, name: 'many' };
}

declare global {
  interface Window {
    /**
     * For each picture: the particles of large draw calls, and the bytes uploaded to the GPU.
     */
    pictures: { particles: number[]; bytes: number }[];
  }
}

/** Runs in the browser, before the page's own scripts. */
function watchPictures(): void {
  window.pictures = [];
  let picture = { particles: [] as number[], bytes: 0 };
  const { prototype } = WebGL2RenderingContext;
  /** Calls `note` with the arguments of each call of a method, before the call. */
  const watch = (method: keyof WebGL2RenderingContext, note: (args: unknown[]) => void): void => {
    const call = prototype[method] as (...args: unknown[]) => void;
    const watched = function (this: WebGL2RenderingContext, ...args: unknown[]): void {
      note(args);
      call.apply(this, args);
    };
    Object.assign(prototype, { [method]: watched });
  };
  const count = (data: unknown): void => {
    if (ArrayBuffer.isView(data)) picture.bytes += data.byteLength;
  };
  watch('drawArrays', ([, , vertices]) => {
    if ((vertices as number) > 6000) picture.particles.push((vertices as number) / 6);
  });
  watch('bufferData', (args) => count(args[1]));
  watch('bufferSubData', (args) => count(args[2]));
  watch('texSubImage2D', (args) => count(args[8]));
  const next = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (callback) =>
    next((now) => {
      picture = { particles: [], bytes: 0 };
      callback(now);
      if (picture.particles.length > 0) window.pictures.push(picture);
    });
}

it('does nothing once per particle on the page thread, and uploads no more than it must', async () => {
  await visits.visit(damBreak(), {
    viewport: { width: 400, height: 300 }, // small, because drawing is not the subject
    view: 'liquid:particles,smooth:on,colour:speed',
    before: (page) => page.addInitScript(watchPictures),
  });
  const { observer, viewer } = visits;
  const { page } = viewer;
  const drawn = (count: number): Promise<unknown> =>
    page.waitForFunction((least) => window.pictures.length >= least, count);
  const step = async (): Promise<void> => {
    const tick = await viewer.tick();
    await observer.request('control.step', { ticks: 1 });
    await viewer.untilTick(tick + 1);
  };
  await drawn(1);
  await visits.untilWhole();
  // If a page draws too slowly while a session plays, the server sends fewer particles. The first
  // picture with all particles then enlarges the buffers.
  await page.evaluate(() => (window.pictures = []));
  await step();
  await drawn(1);
  await page.coverage.startJSCoverage({ resetOnNavigation: false });
  await page.evaluate(() => (window.pictures = []));
  for (let count = 1; count <= kPictures; ++count) {
    await step();
    await drawn(count);
  }
  const coverage = await page.coverage.stopJSCoverage();
  const pictures = await page.evaluate(() => window.pictures);
  for (const { particles, bytes } of pictures) {
    expect(particles).toEqual([kParticles, kParticles]); // shadows on the floor, then the particles
    expect(bytes / kParticles).toBeLessThan(kMostBytes);
  }
  const runs = coverage.flatMap(({ functions }) =>
    functions.flatMap(({ ranges }) => ranges.map(({ count }) => count)),
  );
  expect(Math.max(...runs)).toBeGreaterThanOrEqual(kPictures);
  expect(Math.max(...runs) / pictures.length).toBeLessThan(kMostRuns);
});
