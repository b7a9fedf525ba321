import { expect, it } from 'vitest';
import type { BodyState, Scene, SceneBody } from '../../web/client/index';
import { kPhone, Visits } from './visits';

/** What a scene's editor does beyond adding bodies: materials, interfaces, steps, and all undone. */
const visits = new Visits();

/** No more scenes are asked for than a client may in a second. */
const kInTime = { timeout: 120_000, interval: 500 };

async function visit(scene: string, section: 'build' | 'parameters', tick = 0): Promise<void> {
  await visits.visit(scene, { tick });
  await visits.viewer.page.click(`#${section}-details > summary`);
}

async function bodies(): Promise<BodyState[]> {
  return (await visits.observer.request('state.query', {})).bodies;
}

async function bodyOf(name: string): Promise<BodyState | undefined> {
  return (await bodies()).find((body) => body.name === name);
}

/** Steps that had to be repeated in parts, since the scene was loaded. */
async function undoneSteps(): Promise<number> {
  return (await visits.observer.request('session.stats', {})).undone_substeps;
}

it.each([
  ['rigid-stack', 'liquid', 'sphere', 'water'],
  ['dam-break', 'deformable', 'box', 'jelly'],
  ['dam-break', 'rigid', 'box', 'wood'],
] as const)('adds to %s, which has no material for it, a body that is %s', async (...row) => {
  const [scene, kind, shape, material] = row;
  await visit(scene, 'build');
  const { page } = visits.viewer;
  const before = (await bodies()).length;
  await page.selectOption('#add-kind', kind);
  await page.selectOption('#add-shape', shape);
  await page.selectOption('#add-material', material);
  expect(await page.textContent('#add-material option:checked')).toContain('new in this scene');
  await page.click('#add-place:enabled');
  await visits.viewer.until('#view[data-placing]');
  await page.keyboard.press('ArrowRight');
  await page.keyboard.press('Enter');
  await expect.poll(async () => (await bodies()).length, kInTime).toBe(before + 1);
  const added = (await bodies()).at(-1)!;
  expect(added.kind).toBe(kind);
  expect((await visits.scene()).materials.map(({ name }) => name)).toContain(material);
  await page.waitForSelector(`#bodies li[data-body="${added.body}"]`);
  expect(await page.textContent('#add-material option:checked')).toBe(material);
  await visits.observer.request('control.step', { ticks: 25 });
  expect(await undoneSteps()).toBe(0);
  await page.click('#undo:enabled');
  await expect.poll(async () => (await bodies()).length, kInTime).toBe(before);
  await page.click('#redo:enabled');
  await expect.poll(async () => (await bodies()).length, kInTime).toBe(before + 1);
});

it('changes what happens where two materials meet, and back', async () => {
  await visit('rigid-stack', 'parameters');
  const { page } = visits.viewer;
  const before = (await visits.scene()).default_interface as { stiffness: number };
  await page.selectOption('#contact-first', 'stone');
  await page.selectOption('#contact-second', 'vat');
  expect(await page.inputValue('#contact-stiffness')).toBe(String(before.stiffness));
  expect(await page.textContent('#contact-note')).toContain('As all others');
  const told = async (): Promise<unknown> =>
    (await visits.scene()).interfaces?.find(({ materials }) => materials.includes('stone'));
  await page.fill('#contact-friction', '0.7');
  await page.press('#contact-friction', 'Enter');
  await expect
    .poll(told, kInTime)
    .toMatchObject({ ...before, materials: ['stone', 'vat'], friction: 0.7 });
  await page.fill('#contact-friction', '11');
  await page.press('#contact-friction', 'Enter');
  await page.waitForSelector('.parameter:has(#contact-friction) .fault:has-text("from 0 to 10")');
  await expect.poll(() => page.inputValue('#contact-friction'), kInTime).toBe('0.7');
  // What only the server knows is said beside the field as well.
  await page.fill('#contact-threshold', '5');
  await page.press('#contact-threshold', 'Enter');
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

it('steps with another integrator, in other steps, and as it did', async () => {
  await visit('sliding-vat-solids', 'parameters');
  const { page } = visits.viewer;
  const numerics = async (): Promise<Scene['numerics']> => (await visits.scene()).numerics;
  await page.selectOption('#integrator', 'heun');
  await expect.poll(numerics, kInTime).toMatchObject({ integrator: 'heun', step: 0.001 });
  await page.fill('#steps', '40');
  await page.press('#steps', 'Enter');
  await expect.poll(numerics, kInTime).toMatchObject({ integrator: 'heun', step: 0.0005 });
  await page.waitForSelector('.parameter:has(#steps) small:has-text("of 0.5 ms")');
  await page.fill('#steps', '2.5');
  await page.press('#steps', 'Enter');
  await page.waitForSelector('.parameter:has(#steps) .fault:has-text("whole number from 1")');
  await visits.observer.request('control.step', { ticks: 3 });
  await page.click('button[aria-label="Integrator as it was"]');
  await expect.poll(numerics, kInTime).toMatchObject({ integrator: 'velocity_verlet' });
  await page.click('button[aria-label="Steps in 20 ms as it was"]');
  await expect.poll(numerics, kInTime).toMatchObject({ step: 0.001 });
});

it('says what an integrator cannot do', async () => {
  await visit('brick-wall', 'parameters');
  const { page } = visits.viewer;
  await page.waitForSelector('#integrator:enabled');
  await page.selectOption('#integrator', 'runge_kutta_4');
  await page.waitForSelector('.parameter:has(#integrator) .fault:has-text("projection")');
  expect(await page.inputValue('#integrator')).toBe('velocity_verlet');
});

it('brings back a body that was deleted as it was, bent and moving', async () => {
  await visit('deformable-drop', 'build', 40);
  const before = (await bodyOf('ball'))!;
  const speed = Math.max(...before.velocities.map((v) => Math.hypot(...v)));
  expect(speed).toBeGreaterThan(0.1);
  await visits.viewer.page.click(
    `#bodies li[data-body="${before.body}"] button:has-text("Delete")`,
  );
  await expect.poll(() => bodyOf('ball'), kInTime).toBeUndefined();
  await visits.viewer.page.click('#undo:enabled');
  await expect.poll(() => bodyOf('ball'), kInTime).toBeDefined();
  const back = (await bodyOf('ball'))!;
  expect(back.body).not.toBe(before.body);
  expect(back.positions).toEqual(before.positions);
  expect(back.velocities).toEqual(before.velocities);
});

const plank: SceneBody = {
  name: 'plank',
  kind: 'rigid',
  material: 'wood',
  spacing: 0.05,
  shape: { type: 'box', size: [1.2, 0.1, 0.1] },
  position: [0.8, 0.3, 0.1],
};
const ball: SceneBody = {
  ...plank,
  name: 'ball',
  shape: { type: 'sphere', radius: 0.1 },
  position: [0.8, 0.3, 0.8],
};

it('moves a long body to where it has room, and not into others', async () => {
  await visit('rigid-stack', 'build');
  const { observer, viewer } = visits;
  await observer.request('scene.load', {
    scene: {
      format: 'vat.scene/1',
      name: 'long',
      materials: [{ name: 'wood', density: 600 }],
      vat: { min: [0, 0, 0], max: [1.6, 0.6, 1.2] },
      bodies: [plank, ball],
    },
  });
  await viewer.untilScene('long');
  await viewer.until('#view[data-tick]');
  const move = '#bodies li:has-text("plank") button:has-text("Move")';
  const height = async (): Promise<number> => (await bodyOf('plank'))!.center_of_mass![2];
  await viewer.page.click(move);
  await viewer.until('#view[data-placing]');
  await viewer.page.keyboard.press('Enter'); // below the top, 35 cm above the ball
  await expect.poll(height, kInTime).toBeGreaterThan(1.1);
  await viewer.until('#view:not([data-placing])');
  await viewer.page.click(move);
  await viewer.until('#view[data-placing]');
  // 7 or 8 steps of 4 % of 1.2 m: into the ball.
  for (let n = 0; n < 7; ++n) await viewer.page.keyboard.press('ArrowDown');
  await viewer.page.keyboard.press('Enter');
  await viewer.page.waitForSelector('#notices li:has-text("There is something already")');
  expect(await height()).toBeGreaterThan(1.1);
});

it('has its forms on a phone', async () => {
  await visits.visit('sliding-vat-liquid', kPhone);
  const { page } = visits.viewer;
  await page.tap('#sheet');
  await page.tap('#parameters-details > summary');
  for (const id of ['#material-density', '#contact-law', '#integrator', '#steps']) {
    await page.locator(id).scrollIntoViewIfNeeded();
    const box = (await page.locator(id).boundingBox())!;
    expect(box.x).toBeGreaterThanOrEqual(0);
    expect(box.x + box.width).toBeLessThanOrEqual(kPhone.viewport!.width);
  }
});
