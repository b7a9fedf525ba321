import { afterAll, beforeAll, expect, it } from 'vitest';
import type { BodyState } from '../../web/client/index';
import { Observer } from './support/observer';
import { Server } from './support/server';
import { openPage } from './support/shared';
import type { Viewer } from './support/viewer';
import { kInTime } from './support/visits';

/** A user's visit to the real server. Each test continues the previous one. */
const server = new Server();
let viewer: Viewer;
let observer: Observer;

beforeAll(async () => {
  await server.start();
  viewer = await openPage(server.url, { deviceScaleFactor: 0.5 });
  observer = await Observer.join(server.url);
});

afterAll(async () => {
  observer?.leave();
  await viewer?.close();
  await server.kill();
});

/** A change of fewer pixels could be a single particle. */
const kMovement = 250;

/** Waits until the picture shows the session's present paused state. */
async function untilPaused(): Promise<number> {
  await viewer.until('#play[data-playing="false"]');
  const tick = await observer.tick();
  await viewer.untilTick(tick, tick);
  return tick;
}

/** Pauses the session if it plays. A change of scene may have started it. */
async function pause(): Promise<void> {
  const { playing } = await observer.nextStatus();
  if (playing) await viewer.page.click('#play');
  await untilPaused();
}

async function pickScene(scene: string): Promise<void> {
  await viewer.page.selectOption('#scene', scene);
  await viewer.untilScene(scene);
}

function distance(a: readonly number[], b: readonly number[]): number {
  return Math.hypot(...a.map((value, axis) => value - (b[axis] ?? NaN)));
}

function positionOf(body: BodyState, particle: number): readonly number[] {
  const position = body.positions[particle];
  if (!position) throw new Error(`body "${body.name}" has no particle ${particle}`);
  return position;
}

it('shows the first scene in motion', async () => {
  await viewer.untilScene('sliding-vat-liquid');
  await viewer.until('#connection[data-state="open"]');
  await viewer.untilTick(1);
  const before = await viewer.picture();
  await viewer.untilTick((await viewer.tick()) + 10);
  expect(await viewer.difference(before, await viewer.picture())).toBeGreaterThan(kMovement);
});

it('shows a liquid that moves in a vat at rest', async () => {
  await pickScene('dam-break');
  await viewer.untilTick(1);
  const before = await viewer.picture();
  await viewer.untilTick((await viewer.tick()) + 10);
  expect(await viewer.difference(before, await viewer.picture())).toBeGreaterThan(kMovement);
});

it('pauses with the space bar', async () => {
  await viewer.page.keyboard.press('Space');
  const tick = await untilPaused();
  await viewer.until('#connection[data-slow="false"]'); // a slow page requests the omitted particles
  const before = await viewer.stillPicture();
  const { playing } = await observer.nextStatus();
  await observer.nextStatus();
  expect(playing).toBe(false);
  expect(await viewer.difference(before, await viewer.picture())).toBe(0);
  expect(await viewer.tick()).toBe(tick);
});

it('steps by one tick', async () => {
  const tick = await viewer.tick();
  await viewer.page.click('#step');
  await viewer.untilTick(tick + 1);
  expect(await observer.tick()).toBe(tick + 1);
  await viewer.page.keyboard.press('s');
  await viewer.untilTick(tick + 2);
  expect(await observer.tick()).toBe(tick + 2);
});

it('resets to the scene as loaded', async () => {
  await viewer.page.click('#reset');
  await viewer.untilTick(0, 3);
});

it('pulls a body with the mouse', async () => {
  await pickScene('rigid-stack');
  await pause();
  const { mouse } = viewer.page;
  const point = await viewer.findParticle();
  await mouse.down();
  await viewer.until('#view[data-pointer="holding"]');
  const body = Number(await viewer.said('heldBody'));
  const particle = Number(await viewer.said('heldParticle'));
  await mouse.move(point.x + 60, point.y - 60, { steps: 4 });
  const target = (await viewer.said('heldTarget'))?.split(' ').map(Number) ?? [];
  const away = async (): Promise<number> =>
    distance(positionOf(await observer.body(body), particle), target);
  const before = await away();
  expect(before).toBeGreaterThan(0);
  await viewer.page.keyboard.press('Space');
  await expect.poll(away, kInTime).toBeLessThan(0.5 * before);
  await mouse.up();
  await viewer.until('#view:not([data-held-body])');
});

it('reconnects after the server was killed and started again', async () => {
  observer.leave();
  viewer.serverIsAway = true;
  await server.kill();
  await viewer.until('#connection[data-state="waiting"]');
  expect(await viewer.page.textContent('#connection')).toContain('Not connected');
  await server.start();
  await viewer.until('#connection[data-state="open"]');
  viewer.serverIsAway = false;
  await viewer.untilScene('sliding-vat-liquid');
  const tick = await viewer.tick();
  await viewer.untilTick(tick + 5);
});

it('did all that without an error or a request to elsewhere', () => {
  expect(viewer.problems).toEqual([]);
});
