import { expect, it } from 'vitest';
import type { Scene } from '../../web/client/index';
import { kInTime, unfold, Visits } from './support/visits';

/** Constants of a scene, gravity and the vat: changes within their ranges, and undo. */
const visits = new Visits();

async function visit(scene: string): Promise<void> {
  await visits.visit(scene);
  await unfold(visits.viewer, 'parameters-details');
  await visits.viewer.page.waitForSelector('#integrator:enabled');
}

async function enter(field: string, text: string): Promise<void> {
  await visits.viewer.page.fill(field, text);
  await visits.viewer.page.press(field, 'Enter');
}

it('changes the constants of a material, within their range, and restores them', async () => {
  await visit('dam-break');
  const { page } = visits.viewer;
  const viscosity = async (): Promise<number | undefined> =>
    (await visits.scene()).materials.find(({ liquid }) => liquid)?.liquid?.viscosity;
  const before = (await viscosity())!;
  const field = '#material-liquid-viscosity';
  await enter(field, String(before + 3));
  await expect.poll(viscosity, kInTime).toBe(before + 3);
  // The second edit precedes the reply to the first, which must not remove the error.
  const reset = 'button[aria-label="Reset Viscosity"]';
  await page.evaluate(
    ([button, input]) => {
      document.querySelector<HTMLButtonElement>(button)!.click();
      const number = document.querySelector<HTMLInputElement>(input)!;
      number.value = '-1';
      number.dispatchEvent(new Event('change'));
    },
    [reset, field] as const,
  );
  await expect.poll(viscosity, kInTime).toBe(before);
  // The page has received that reply if it shows the result of a later change.
  await enter('#material-density', '900');
  await page.waitForSelector('button[aria-label="Reset Density"]', { state: 'visible' });
  const fault = page.locator(`.parameter:has(${field}) .fault`);
  expect(await fault.isVisible()).toBe(true);
  expect(await fault.textContent()).toContain('from 0 to');
  await expect.poll(() => page.inputValue(field), kInTime).toBe(String(before));
});

it('takes no change before it shows the constants of the present scene', async () => {
  await visit('dam-break');
  await visits.visit('dam-break'); // closes the section
  const { page } = visits.viewer;
  for (const field of ['#material-density', '#integrator', '#steps'])
    expect(await page.isDisabled(field), field).toBe(true);
  await unfold(visits.viewer, 'parameters-details');
  await page.waitForSelector('#material-density:enabled');
});

it('keeps a change whose result follows the next change', async () => {
  await visit('dam-break');
  await visits.viewer.page.evaluate(
    (edits) => {
      for (const [field, value] of edits) {
        const input = document.querySelector<HTMLInputElement>(field)!;
        input.value = value;
        input.dispatchEvent(new Event('change'));
      }
    },
    [
      ['#material-liquid-viscosity', '2'],
      ['#material-density', '900'],
    ] as const,
  );
  const constants = async (): Promise<unknown> => {
    const { liquid, density } = (await visits.scene()).materials.find(({ liquid }) => liquid)!;
    return [liquid!.viscosity, density];
  };
  await expect.poll(constants, kInTime).toEqual([2, 900]);
});

it('changes the appearance of a material, which is drawn, and restores it', async () => {
  await visit('rigid-stack');
  const { page } = visits.viewer;
  const appearance = async (): Promise<unknown> =>
    (await visits.scene()).materials.find(({ name }) => name === 'wood')?.appearance;
  const before = await visits.viewer.stillPicture();
  const changed = async (): Promise<number> =>
    visits.viewer.difference(before, await visits.viewer.picture());
  await page.selectOption('#material', 'wood');
  expect(await page.isVisible('#appearance-absorption_length')).toBe(false); // only of liquids
  const brown = await page.inputValue('#appearance-colour');
  await page.fill('#appearance-colour', '#2040ff');
  await page.dispatchEvent('#appearance-colour', 'change');
  await expect.poll(appearance, kInTime).toEqual({ colour: '#2040ff' });
  await expect.poll(changed, kInTime).toBeGreaterThan(1000);
  await page.selectOption('#appearance-finish', 'brick');
  await expect.poll(appearance, kInTime).toEqual({ colour: '#2040ff', finish: 'brick' });
  await enter('#appearance-roughness', '2');
  await page.waitForSelector(
    '.parameter:has(#appearance-roughness) .fault:has-text("from 0 to 1")',
  );
  await page.click('#appearance-reset');
  await expect.poll(appearance, kInTime).toBeUndefined();
  await expect.poll(() => page.inputValue('#appearance-colour'), kInTime).toBe(brown);
  await expect.poll(changed, kInTime).toBeLessThan(20);
});

it('changes the interface of two materials, and restores it', async () => {
  await visit('rigid-stack');
  const { page } = visits.viewer;
  const before = (await visits.scene()).default_interface as { stiffness: number };
  await page.selectOption('#contact-first', 'stone');
  await page.selectOption('#contact-second', 'vat');
  expect(await page.inputValue('#contact-stiffness')).toBe(String(before.stiffness));
  expect(await page.textContent('#contact-note')).toContain('The default of this scene');
  const told = async (): Promise<unknown> =>
    (await visits.scene()).interfaces?.find(({ materials }) => materials.includes('stone'));
  await enter('#contact-friction', '0.7');
  await expect
    .poll(told, kInTime)
    .toMatchObject({ ...before, materials: ['stone', 'vat'], friction: 0.7 });
  await enter('#contact-friction', '11');
  await page.waitForSelector('.parameter:has(#contact-friction) .fault:has-text("from 0 to 10")');
  await expect.poll(() => page.inputValue('#contact-friction'), kInTime).toBe('0.7');
  // Errors that only the server detects are also shown next to the field.
  await enter('#contact-threshold', '5');
  await page.waitForSelector('.parameter:has(#contact-threshold) .fault:has-text("0.4")');
  await page.selectOption('#contact-law', 'projection');
  await expect.poll(told, kInTime).toMatchObject({ law: 'projection', friction: 0.7 });
  await page.waitForSelector('#contact-stiffness', { state: 'detached' });
  await page.selectOption('#contact-law', 'sph');
  await page.waitForSelector('.build-form > .fault:has-text("liquid")');
  await expect.poll(() => page.inputValue('#contact-law'), kInTime).toBe('projection');
  await page.click('#contact-reset');
  await expect.poll(told, kInTime).toMatchObject(before);
  await page.waitForSelector('#contact-stiffness');
  await page.waitForSelector('#contact-reset', { state: 'hidden' });
});

it('changes integrator and time step, and restores them', async () => {
  await visit('sliding-vat-solids');
  const { page } = visits.viewer;
  const numerics = async (): Promise<Scene['numerics']> => (await visits.scene()).numerics;
  await page.selectOption('#integrator', 'heun');
  await expect.poll(numerics, kInTime).toMatchObject({ integrator: 'heun', step: 0.001 });
  await enter('#steps', '40');
  await expect.poll(numerics, kInTime).toMatchObject({ integrator: 'heun', step: 0.0005 });
  await page.waitForSelector('.parameter:has(#steps) small:has-text("of 0.5 ms")');
  await enter('#steps', '2.5');
  await page.waitForSelector('.parameter:has(#steps) .fault:has-text("whole number from 1")');
  await visits.observer.request('control.step', { ticks: 3 });
  await page.click('button[aria-label="Reset Integrator"]');
  await expect.poll(numerics, kInTime).toMatchObject({ integrator: 'velocity_verlet' });
  await page.click('button[aria-label="Reset Steps in 20 ms"]');
  await expect.poll(numerics, kInTime).toMatchObject({ step: 0.001 });
});

it('shows the reason for the rejection of an integrator', async () => {
  await visit('brick-wall');
  const { page } = visits.viewer;
  await page.selectOption('#integrator', 'runge_kutta_4');
  await page.waitForSelector('.parameter:has(#integrator) .fault:has-text("projection")');
  expect(await page.inputValue('#integrator')).toBe('velocity_verlet');
});

/** Drags from the middle of a pad to the right by a fraction of its width. */
async function drag(pad: string, share: number): Promise<void> {
  const { page } = visits.viewer;
  await page.locator(pad).scrollIntoViewIfNeeded();
  const box = (await page.locator(pad).boundingBox())!;
  const y = box.y + box.height / 2;
  await page.mouse.move(box.x + box.width / 2, y);
  await page.mouse.down();
  await page.mouse.move(box.x + (0.5 + share) * box.width, y, { steps: 3 });
}

it('tilts gravity with the ball, and restores it', async () => {
  await visit('rigid-stack');
  const { page } = visits.viewer;
  const gravity = async (): Promise<number[]> =>
    (await visits.observer.request('session.join', {})).description.gravity;
  await drag('#tilt', 0.25);
  await page.mouse.up();
  // Half of the distance is half of 60 degrees. A pixel is two degrees.
  await expect.poll(async () => (await gravity())[0], kInTime).toBeGreaterThan(4.6);
  expect((await gravity())[0]).toBeLessThan(5.2);
  await page.click('#gravity-reset');
  await expect.poll(gravity, kInTime).toEqual([0, 0, -9.81]);
});

it('slides the vat by hand; after the release, the vat returns', async () => {
  await visit('dam-break');
  const { vat } = (await visits.observer.request('session.join', {})).description;
  await drag('#slide', 0.48);
  /** Returns the displacement of the liquid relative to the vat. */
  const offset = async (): Promise<number> => {
    await visits.observer.request('control.step', { ticks: 50 });
    const { bodies } = await visits.observer.request('state.query', {});
    const { positions } = bodies.find(({ kind }) => kind === 'liquid')!;
    return Math.max(...positions.map(([x]) => x)) - vat!.max[0];
  };
  await expect.poll(offset, kInTime).toBeGreaterThan(0.05);
  await visits.viewer.page.mouse.up();
  await expect.poll(offset, kInTime).toBeLessThan(0.01);
});
