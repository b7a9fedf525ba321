import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { afterAll, afterEach, beforeAll, expect, it } from 'vitest';
import type { Scene } from '../../web/client/index';
import { Observer } from './observer';
import { Server } from './server';
import { Viewer } from './viewer';

/**
 * What many particles cost the page's own thread, in time of a processor: what others take from it
 * here is left out, and the drawing too, which another process does.
 */
const server = new Server(['--max-particle-steps-per-tick', '10000000']);
let viewer: Viewer;
let observer: Observer;

/** A thread that is busy for longer is felt by who uses the page. */
const kMostBlockedMs = 50;
/** Between two pictures, at 60 a second. */
const kPictureMs = 1000 / 60;

beforeAll(async () => {
  await server.start();
  observer = await Observer.join(server.url);
});
afterEach(() => viewer.close());
afterAll(async () => {
  observer.leave();
  await server.kill();
});

/** The dam break with particles so far apart [m]. */
function damBreak(spacing: number): Scene {
  const path = new URL('../../protocol/scenes/dam-break.json', import.meta.url);
  const scene = JSON.parse(readFileSync(fileURLToPath(path), 'utf8')) as Scene;
  const [body] = scene.bodies ?? [];
  const [material] = scene.materials ?? [];
  if (!body || !material?.liquid || !scene.numerics) throw new Error('the dam break has changed');
  const scale = spacing / 0.04;
  Object.assign(body, { spacing });
  Object.assign(material.liquid, { support_radius: 2 * spacing });
  Object.assign(scene.numerics, { step: 0.0025 * scale });
  return { ...scene, name: 'many' };
}

declare global {
  interface Window {
    /** Of each picture: how many instances each call drew. */
    pictures: number[][];
  }
}

/** Runs in the browser, before the page's own scripts. */
function watchPictures(): void {
  window.pictures = [];
  let instances: number[] = [];
  const { prototype } = WebGL2RenderingContext;
  const draw = Object.getOwnPropertyDescriptor(prototype, 'drawElementsInstanced')!
    .value as WebGL2RenderingContext['drawElementsInstanced'];
  prototype.drawElementsInstanced = function (...args): void {
    instances.push(args[4]);
    draw.apply(this, args);
  };
  const next = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (callback) =>
    next((now) => {
      instances = [];
      callback(now);
      const many = instances.filter((count) => count > 1000);
      if (many.length > 0) window.pictures.push(many);
    });
}

interface Task {
  name: string;
  /** Of a processor [ms]. */
  busy: number;
}

/** What the page's own thread does while so many more pictures are drawn. */
async function tasksOf(pictures: number): Promise<Task[]> {
  const browser = viewer.page.context().browser()!;
  await browser.startTracing(viewer.page, {
    categories: ['toplevel', 'devtools.timeline', 'disabled-by-default-devtools.timeline'],
  });
  await viewer.page.evaluate(() => (window.pictures = []));
  await viewer.page.waitForFunction((least) => window.pictures.length >= least, pictures);
  const { traceEvents } = JSON.parse((await browser.stopTracing()).toString()) as {
    traceEvents: {
      pid: number;
      tid: number;
      name: string;
      args: { name?: string };
      tdur?: number;
    }[];
  };
  const own = traceEvents.find(
    ({ name, args }) => name === 'thread_name' && args.name === 'CrRendererMain',
  )!;
  return traceEvents.flatMap(({ pid, tid, name, tdur }) =>
    pid === own.pid && tid === own.tid && tdur !== undefined ? [{ name, busy: tdur / 1000 }] : [],
  );
}

/** The page with the dam break of particles so far apart [m], moving. */
async function visit(spacing: number): Promise<void> {
  await observer.request('scene.load', { scene: damBreak(spacing) });
  // A page that draws too slowly is sent fewer particles: the solver leaves it the processor.
  await observer.request('control.set_speed', { speed: 0.1 });
  viewer = await Viewer.open(`${server.url}#view=liquid:particles,smooth:on,colour:speed`, {
    viewport: { width: 300, height: 200 }, // small, for drawing is not what is timed
    prepare: watchPictures,
  });
  await viewer.untilTick(1);
  await viewer.page.waitForFunction(() => window.pictures.length > 2); // shaders are compiled
}

it.each([
  [31250, 0.016, 20],
  [128000, 0.01, 4], // the processor draws one a second
])('takes %i moving particles without blocking', async (count, spacing, least) => {
  await visit(spacing);
  const first = await viewer.page.evaluate(() => window.pictures[0]);
  const tasks = await tasksOf(least);
  // Shadows on the floor, then the particles. At first all of them; to a page that draws slower
  // than they come the server then sends fewer.
  expect(first).toEqual([count, count]);
  const drawn = await viewer.page.evaluate(() => window.pictures);
  expect(drawn).toEqual(drawn.map(([instances]) => [instances, instances]));
  const pictures = tasks.filter(({ name }) => name === 'FireAnimationFrame');
  expect(pictures.length).toBeGreaterThanOrEqual(least);
  expect(Math.max(...tasks.map(({ busy }) => busy))).toBeLessThan(kMostBlockedMs);
  expect(Math.max(...pictures.map(({ busy }) => busy))).toBeLessThan(kPictureMs);
  expect(viewer.problems).toEqual([]);
});
