import type { Page } from 'playwright-core';
import { expect, it } from 'vitest';
import type { Scene } from '../../web/client/index';
import type { Viewer } from './support/viewer';
import { linked } from './support/link';
import { kInTime, Visits } from './support/visits';

/** Input on the picture: mouse, pen, fingers and keys. */
const visits = new Visits();

interface Point {
  x: number;
  y: number;
}

/** An input device that presses, drags and releases. */
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

/** Waits until the camera rests. Returns its distance from its target, and its direction. */
async function view(): Promise<{ distance: number; direction: number[] }> {
  let camera: number[] = [];
  for (let last = ''; last === '' || last !== String(camera);) {
    last = String(camera);
    ({ camera } = await linked(visits.viewer.page));
  }
  const way = [0, 1, 2].map((axis) => camera[axis]! - camera[axis + 3]!);
  const distance = Math.hypot(...way);
  return { distance, direction: way.map((x) => x / distance) };
}

/** Waits until the direction of the camera differs from another one. Returns the distance. */
async function turnedFrom(before: number[]): Promise<number> {
  let distance = 0;
  const change = async (): Promise<number> => {
    const now = await view();
    ({ distance } = now);
    return Math.hypot(...now.direction.map((x, axis) => x - before[axis]!));
  };
  await expect.poll(change, kInTime).toBeGreaterThan(0.1);
  return distance;
}

it('turns and zooms by fingers on nothing, and turns by keys', async () => {
  await visits.visit('rigid-stack', { hasTouch: true });
  const { viewer } = visits;
  const touch = await touchesOf(viewer.page);
  const box = (await viewer.page.locator('#view').boundingBox())!;
  const corner = { x: box.x + 0.2 * box.width, y: box.y + 0.15 * box.height };
  const picture = await viewer.stillPicture();
  const before = await view();
  await touch('touchStart', corner);
  for (let n = 1; n <= 4; ++n) await touch('touchMove', { x: corner.x + 20 * n, y: corner.y });
  await touch('touchEnd');
  expect(await turnedFrom(before.direction)).toBeCloseTo(before.distance, 3);
  const other = { x: corner.x + 40, y: corner.y };
  await touch('touchStart', corner);
  await touch('touchStart', corner, other);
  for (let n = 1; n <= 4; ++n) {
    await touch('touchMove', corner, { x: other.x + 20 * n, y: other.y });
  }
  await touch('touchEnd');
  await expect
    .poll(async () => (await view()).distance / before.distance, kInTime)
    .toBeLessThan(0.9);
  expect(await grabs()).toEqual([]);
  const { direction } = await view();
  await viewer.page.focus('#view');
  for (let n = 0; n < 6; ++n) await viewer.page.keyboard.press('ArrowRight');
  await turnedFrom(direction);
  expect(await viewer.difference(picture, await viewer.stillPicture())).toBeGreaterThan(1000);
});

it('holds a body by keys, pulls it, and releases it', async () => {
  await visits.visit('rigid-stack');
  const { observer, viewer } = visits;
  const { page } = viewer;
  await page.focus('#view');
  await page.keyboard.press('b');
  await viewer.until('#view[data-held-body]');
  const held = Number(await viewer.said('heldBody'));
  const target = async (): Promise<number[]> =>
    (await viewer.said('heldTarget'))!.split(' ').map(Number);
  const before = await target();
  for (let n = 0; n < 8; ++n) await page.keyboard.press('ArrowUp');
  const [x, y, z] = await target();
  expect([x, y]).toEqual(before.slice(0, 2));
  expect(z).toBeGreaterThan(before[2]! + 0.05);
  await expect.poll(() => page.textContent('#summary'), kInTime).toContain('you hold');
  await expect.poll(grabs, kInTime).toEqual([held]);
  const height = async (): Promise<number> => {
    const { positions } = await observer.body(held);
    return positions.reduce((sum, place) => sum + place[2], 0) / positions.length;
  };
  const low = await height();
  const lifted = async (): Promise<number> => {
    await observer.request('control.step', { ticks: 20 });
    return (await height()) - low;
  };
  await expect.poll(lifted, kInTime).toBeGreaterThan(0.02);
  await page.keyboard.press('b'); // the next body
  await expect.poll(async () => (await grabs())[0] !== held, kInTime).toBe(true);
  await page.keyboard.press('Escape');
  await viewer.until('#view:not([data-held-body])');
  await expect.poll(grabs, kInTime).toEqual([]);
});

/** A block of 0.024 m³ whose particles have different coordinates on each axis. */
const kBlock: Scene = {
  format: 'vat.scene/1',
  name: 'one block',
  materials: [{ name: 'wood', density: 600 }],
  vat: { min: [0, 0, 0], max: [1, 1, 1] },
  bodies: [
    {
      name: 'block',
      kind: 'rigid',
      material: 'wood',
      spacing: 0.05,
      shape: { type: 'box', size: [0.4, 0.2, 0.3] },
      position: [0.25, 0.8, 0.5],
    },
  ],
};

it('shows position, density and mass of the clicked particle', async () => {
  await visits.visit(kBlock);
  const { viewer, observer } = visits;
  await viewer.clickParticle();
  await viewer.page.waitForSelector('#inspector:has-text("Mass")');
  const text = (await viewer.page.textContent('#inspector')) ?? '';
  const particle = Number(/^block · particle (\d+)/.exec(text)![1]);
  const { bodies } = await observer.request('state.query', {});
  const place = bodies[0]!.positions[particle]!;
  const [x, y, z] = /Position([-\d.]+), ([-\d.]+), ([-\d.]+) m/.exec(text)!.slice(1).map(Number);
  expect(Math.hypot(x! - place[0], y! - place[1], z! - place[2])).toBeLessThan(0.005);
  expect(text).toContain('Density600 kg/m³');
  expect(text).toContain('Mass14.4 kg');
});
