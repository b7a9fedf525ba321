import { expect, it } from 'vitest';
import { kInTime, Visits } from './support/visits';

/** Pouring liquid: drops, and taps of a scene. */
const visits = new Visits();

it('pours drops below the top, each at a free place', async () => {
  await visits.visit('dam-break');
  const { page } = visits.viewer;
  const bodies = async () => (await visits.observer.request('state.query', {})).bodies;
  const before = (await bodies()).length;
  const drops = async (): Promise<number> => (await bodies()).length - before;
  await page.click('#pour');
  await expect.poll(drops, kInTime).toBe(1);
  for (const [, , speed] of (await bodies()).at(-1)!.velocities) expect(speed).toBeLessThan(0);
  await page.focus('#view');
  // The key repeats. No drop is added before the last one is visible.
  const poured = async (): Promise<number> => {
    await page.keyboard.press('p');
    await page.keyboard.press('p');
    return drops();
  };
  await expect.poll(poured, kInTime).toBeGreaterThan(1);
  const [first, second] = (await bodies())
    .slice(before, before + 2)
    .map(({ positions }) => positions);
  const { vat } = (await visits.observer.request('session.join', {})).description;
  for (const [x, y, z] of [...first!, ...second!]) {
    expect(x > vat!.min[0] && x < vat!.max[0] && y > vat!.min[1] && y < vat!.max[1]).toBe(true);
    expect(z).toBeGreaterThan(vat!.min[2] + 0.5 * (vat!.max[2] - vat!.min[2]));
  }
  const spacing = (await visits.scene()).bodies[0]!.spacing!;
  const gaps = first!.flatMap((a) =>
    second!.map((b) => Math.hypot(...a.map((value, axis) => value - b[axis]!))),
  );
  expect(Math.min(...gaps)).toBeGreaterThan(spacing);
});

it('opens and closes the taps of a scene', async () => {
  await visits.visit('pour');
  const isOpen = async (): Promise<boolean | undefined> =>
    (await visits.scene()).emitters?.[0]?.open;
  const tap = visits.viewer.page.locator('#pour-row button[data-emitter="tap"]');
  expect(await tap.textContent()).toBe('Close tap');
  await tap.click();
  await expect.poll(isOpen, kInTime).toBe(false);
  await visits.viewer.page.waitForSelector('#pour-row button:has-text("Open tap")');
  await tap.click();
  await expect.poll(async () => (await isOpen()) ?? true, kInTime).toBe(true);
});

it('disables pouring in scenes without a liquid', async () => {
  await visits.visit('rigid-stack');
  expect(await visits.viewer.page.isVisible('#pour-row')).toBe(false);
});
