import { expect, it } from 'vitest';
import { kInTime, kPhone, Visits } from './support/visits';

/** The tools Push and Tilt, by pointer and by keys. */
const visits = new Visits();

const gravity = async (): Promise<number[]> =>
  (await visits.observer.request('session.join', {})).description.gravity;

/** Returns the mean velocity of a body after some steps. */
async function velocityOf(body: number): Promise<number[]> {
  await visits.observer.request('control.step', { ticks: 6 });
  const { velocities } = await visits.observer.body(body);
  return [0, 1, 2].map(
    (axis) => velocities.reduce((sum, v) => sum + v[axis]!, 0) / velocities.length,
  );
}

it('pushes a body towards the point of release', async () => {
  await visits.visit('rigid-stack');
  const { viewer } = visits;
  const { page } = viewer;
  await page.click('#tool-push');
  const { x, y } = await viewer.findParticle();
  await page.mouse.down();
  await viewer.until('#view[data-held-body]');
  const body = Number(await viewer.said('heldBody'));
  await page.mouse.move(x + 60, y);
  await page.mouse.up();
  await viewer.until('#view:not([data-held-body])');
  // The initial view has x to the right.
  await expect.poll(async () => (await velocityOf(body))[0], kInTime).toBeGreaterThan(0.3);
  const { participants } = await visits.observer.request('presence.list', {});
  expect(participants.flatMap(({ grabs }) => grabs)).toEqual([]);
});

it('aims by arrow keys and pushes by the Enter key, but not by the Escape key', async () => {
  await visits.visit('deformable-drop');
  const { page } = visits.viewer;
  await page.focus('#view');
  await page.keyboard.press('2');
  const aim = async (end: 'Enter' | 'Escape'): Promise<number> => {
    await page.keyboard.press('b');
    await visits.viewer.until('#view[data-held-body]');
    const body = Number(await visits.viewer.said('heldBody'));
    for (let n = 0; n < 8; ++n) await page.keyboard.press('ArrowRight');
    await page.keyboard.press(end);
    await visits.viewer.until('#view:not([data-held-body])');
    return body;
  };
  const cancelled = await aim('Escape');
  const pushed = await aim('Enter');
  await expect.poll(async () => (await velocityOf(pushed))[0], kInTime).toBeGreaterThan(0.5);
  expect((await velocityOf(cancelled))[0]).toBeLessThan(0.1);
});

it('tilts gravity while the pointer drags', async () => {
  await visits.visit('dam-break');
  const { page } = visits.viewer;
  await page.click('#tool-tilt');
  const box = (await page.locator('#view').boundingBox())!;
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 3];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x + 100, y);
  await expect.poll(async () => (await gravity())[0], kInTime).toBeGreaterThan(1);
  expect(Math.hypot(...(await gravity()))).toBeCloseTo(9.81, 1);
  await page.mouse.up();
  await expect.poll(gravity, kInTime).toEqual([0, 0, -9.81]);
  await page.keyboard.press('1');
  await visits.viewer.until('#tool-grab[aria-pressed="true"]');
  await visits.viewer.until('#tool-tilt[aria-pressed="false"]');
});

it('tilts gravity by arrow keys until the Escape key', async () => {
  await visits.visit('dam-break');
  const { page } = visits.viewer;
  await page.keyboard.press('3');
  await page.focus('#view');
  for (let n = 0; n < 3; ++n) await page.keyboard.press('ArrowRight');
  await expect.poll(async () => (await gravity())[0], kInTime).toBeGreaterThan(1);
  await page.keyboard.press('Escape');
  await expect.poll(gravity, kInTime).toEqual([0, 0, -9.81]);
});

it('has all tools within the reach of a thumb on a phone', async () => {
  await visits.visit('dam-break', kPhone);
  const { page } = visits.viewer;
  const ids = ['play', 'step', 'reset', 'scene', 'tool-grab', 'tool-push', 'tool-tilt', 'pour'];
  for (const id of [...ids, 'camera-open', 'sheet']) {
    const box = (await page.locator(`#${id}`).boundingBox())!;
    expect(box.y, id).toBeGreaterThan(400); // the lower half
    expect(Math.min(box.width, box.height), id).toBeGreaterThanOrEqual(40);
  }
});
