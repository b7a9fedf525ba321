import type { Page } from 'playwright-core';
import { expect, it } from 'vitest';
import type { Viewer } from './viewer';
import { Visits } from './visits';

/** Hands on the picture itself: mouse, pen and fingers. */
const visits = new Visits();

const kInTime = { timeout: 120_000, interval: 200 };

interface Point {
  x: number;
  y: number;
}

/** What presses, drags and lifts as a device of that kind does. */
interface Hand {
  press(at: Point): Promise<void>;
  drag(to: Point): Promise<void>;
  lift(at: Point): Promise<void>;
}

type TouchType = 'touchStart' | 'touchMove' | 'touchEnd';
type Device = 'mouse' | 'pen' | 'touch';

async function touchesOf(page: Page): Promise<(type: TouchType, ...at: Point[]) => Promise<void>> {
  const input = await page.context().newCDPSession(page);
  return async (type, ...touchPoints) =>
    void (await input.send('Input.dispatchTouchEvent', { type, touchPoints }));
}

async function handOf(device: Device, { page }: Viewer): Promise<Hand> {
  if (device === 'touch') {
    const touch = await touchesOf(page);
    return {
      press: (at) => touch('touchStart', at),
      drag: (to) => touch('touchMove', to),
      lift: () => touch('touchEnd'),
    };
  }
  const input = await page.context().newCDPSession(page);
  const point = async (
    type: 'mousePressed' | 'mouseMoved' | 'mouseReleased',
    { x, y }: Point,
  ): Promise<void> => {
    const buttons = type === 'mouseReleased' ? 0 : 1;
    const pressed = { button: 'left', buttons, clickCount: 1, pointerType: device } as const;
    await input.send('Input.dispatchMouseEvent', { type, x, y, ...pressed });
  };
  return {
    press: (at) => point('mousePressed', at),
    drag: (to) => point('mouseMoved', to),
    lift: (at) => point('mouseReleased', at),
  };
}

const grabs = async (): Promise<number[]> =>
  (await visits.observer.request('presence.list', {})).participants.flatMap((one) => one.grabs);

it.each<[Device, string, string]>([
  ['mouse', 'liquid', 'dam-break'],
  ['mouse', 'deformable', 'deformable-drop'],
  ['pen', 'rigid', 'rigid-stack'],
  ['touch', 'rigid', 'rigid-stack'],
  ['touch', 'liquid', 'dam-break'],
])('pulls with a %s what is %s', async (device, kind, scene) => {
  await visits.visit(scene, { hasTouch: device === 'touch' });
  const { viewer, observer } = visits;
  const hand = await handOf(device, viewer);
  const kindOf = async (body: number): Promise<string> => (await observer.body(body)).kind;
  let at = await viewer.findParticle();
  await hand.press(at);
  await viewer.until('#view[data-pointer="holding"]');
  const body = Number(await viewer.said('heldBody'));
  const particle = Number(await viewer.said('heldParticle'));
  expect(await kindOf(body)).toBe(kind);
  const height = async (): Promise<number> => (await observer.body(body)).positions[particle]![2];
  const low = await height();
  for (let n = 0; n < 4; ++n) await hand.drag((at = { x: at.x + 5, y: at.y - 20 }));
  await expect
    .poll(async () => Number((await viewer.said('heldTarget'))?.split(' ')[2]), kInTime)
    .toBeGreaterThan(low + 0.05);
  await expect.poll(grabs, kInTime).toEqual([body]);
  const lifted = async (): Promise<number> => {
    await observer.request('control.step', { ticks: 10 });
    return (await height()) - low;
  };
  await expect.poll(lifted, kInTime).toBeGreaterThan(0.03);
  await hand.lift(at);
  await viewer.until('#view:not([data-held-body])');
  await expect.poll(grabs, kInTime).toEqual([]);
});

it('turns and zooms by fingers on nothing', async () => {
  await visits.visit('rigid-stack', { hasTouch: true });
  const { viewer } = visits;
  const touch = await touchesOf(viewer.page);
  const box = (await viewer.page.locator('#view').boundingBox())!;
  const corner = { x: box.x + 0.2 * box.width, y: box.y + 0.15 * box.height };
  const before = await viewer.picture();
  await touch('touchStart', corner);
  for (let n = 1; n <= 4; ++n) await touch('touchMove', { x: corner.x + 20 * n, y: corner.y });
  await touch('touchEnd');
  await expect
    .poll(async () => viewer.difference(before, await viewer.picture()), kInTime)
    .toBeGreaterThan(3000);
  const turned = await viewer.picture();
  const other = { x: corner.x + 40, y: corner.y };
  await touch('touchStart', corner);
  await touch('touchStart', corner, other);
  for (let n = 1; n <= 4; ++n) {
    await touch('touchMove', corner, { x: other.x + 20 * n, y: other.y });
  }
  await touch('touchEnd');
  await expect
    .poll(async () => viewer.difference(turned, await viewer.picture()), kInTime)
    .toBeGreaterThan(3000);
  expect(await grabs()).toEqual([]);
});
