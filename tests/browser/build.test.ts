import { expect, it } from 'vitest';
import type { BodyState, Scene, SceneBody } from '../../web/client/index';
import { kInTime, unfold, Visits } from './support/visits';

/** Building a scene: bodies are added, moved, changed and deleted, and each change is undone. */
const visits = new Visits();

async function visit(scene: string | Scene, tick = 0): Promise<void> {
  await visits.visit(scene, { tick });
  await unfold(visits.viewer, 'build-details');
  await visits.viewer.page.waitForSelector('#bodies li[data-body]');
  expect(await visits.viewer.page.isDisabled('#undo')).toBe(true); // changes of another scene
}

async function bodies(): Promise<BodyState[]> {
  return (await visits.observer.request('state.query', {})).bodies;
}
const names = async (): Promise<string[]> => (await bodies()).map(({ name }) => name);
const count = async (): Promise<number> => (await bodies()).length;
const bodyOf = async (name: string): Promise<BodyState | undefined> =>
  (await bodies()).find((body) => body.name === name);

async function choose(kind: string, shape: string, size: number): Promise<void> {
  const { page } = visits.viewer;
  await page.selectOption('#add-kind', kind);
  await page.selectOption('#add-shape', shape);
  await page.fill('#add-size', String(size));
}

/** Presses keys after placing has started. */
async function place(...keys: string[]): Promise<void> {
  await visits.viewer.until('#view[data-placing]');
  for (const key of keys) await visits.viewer.page.keyboard.press(key);
}

it('adds a body at the clicked place, undoes and redoes it', async () => {
  await visit('sliding-vat-liquid');
  const { page } = visits.viewer;
  const block = (await bodyOf('jelly block'))!;
  await visits.observer.request('world.remove_body', { body: block.body });
  await page.waitForSelector('#bodies:not(:has-text("jelly block"))');
  await visits.viewer.until('#view[data-tick]');
  const before = await names();
  await choose('deformable', 'sphere', 0.2);
  await page.click('#add-place:enabled');
  await place();
  const box = (await page.locator('#view').boundingBox())!;
  await page.mouse.click(box.x + 0.3 * box.width, box.y + 0.38 * box.height); // the old position
  await expect.poll(count, kInTime).toBe(before.length + 1);
  await visits.viewer.until('#view:not([data-placing])');
  const added = (await bodies()).at(-1)!;
  expect(added.kind).toBe('deformable');
  const middle = [0, 1, 2].map(
    (axis) => added.positions.reduce((sum, at) => sum + at[axis]!, 0) / added.positions.length,
  );
  const { vat } = (await visits.observer.request('session.join', {})).description;
  const across = (middle[0]! - vat!.min[0]) / (vat!.max[0] - vat!.min[0]);
  expect(across).toBeLessThan(0.5); // to the left, and high
  expect(middle[2]!).toBeGreaterThan(vat!.min[2] + 0.4 * (vat!.max[2] - vat!.min[2]));
  const note = (await page.textContent('#add-note')) ?? '';
  const share = Number(/About (\d+)/.exec(note)?.[1]) / added.positions.length;
  expect(share).toBeGreaterThan(0.5);
  expect(share).toBeLessThan(2);
  await page.click('#undo:enabled');
  await expect.poll(names, kInTime).toEqual(before);
  await page.waitForSelector('#redo:enabled');
  await page.keyboard.press('Control+y');
  await expect.poll(count, kInTime).toBe(before.length + 1);
  await page.waitForSelector('#undo:enabled');
  await page.keyboard.press('Control+z');
  await expect.poll(names, kInTime).toEqual(before);
});

it.each([
  ['rigid-stack', 'liquid', 'sphere', 'water'],
  ['dam-break', 'deformable', 'box', 'jelly'],
  ['dam-break', 'rigid', 'box', 'wood'],
] as const)('adds to %s, which has no material for it, a %s body', async (...row) => {
  const [scene, kind, shape, material] = row;
  await visit(scene);
  const { page } = visits.viewer;
  const before = await count();
  await page.selectOption('#add-kind', kind);
  await page.selectOption('#add-shape', shape);
  await page.selectOption('#add-material', material);
  expect(await page.textContent('#add-material option:checked')).toContain('(new)');
  await page.click('#add-place:enabled');
  await place('ArrowRight', 'Enter');
  await expect.poll(count, kInTime).toBe(before + 1);
  const added = (await bodies()).at(-1)!;
  expect(added.kind).toBe(kind);
  expect((await visits.scene()).materials.map(({ name }) => name)).toContain(material);
  await page.waitForSelector(`#bodies li[data-body="${added.body}"]`);
  expect(await page.textContent('#add-material option:checked')).toBe(material);
  await visits.observer.request('control.step', { ticks: 25 });
  // Number of steps that the guard divided.
  expect((await visits.observer.request('session.stats', {})).undone_substeps).toBe(0);
  await page.click('#undo:enabled');
  await expect.poll(count, kInTime).toBe(before);
  await page.click('#redo:enabled');
  await expect.poll(count, kInTime).toBe(before + 1);
});

it('places bodies by keys, but not inside another body', async () => {
  await visit('rigid-stack');
  const { page } = visits.viewer;
  const before = await count();
  await choose('rigid', 'sphere', 0.1);
  await page.click('#add-place:enabled');
  await place(...Array<string>(40).fill('ArrowDown'), 'Escape'); // moves it as far as possible
  await visits.viewer.until('#view:not([data-placing])');
  expect(await count()).toBe(before);
  await page.click('#add-place');
  await place('ArrowLeft', 'Enter');
  await expect.poll(count, kInTime).toBe(before + 1);
  await page.waitForSelector(`#bodies li:nth-child(${before + 1})`);
  await page.click('#add-place');
  await place('ArrowLeft', 'Enter');
  await page.waitForSelector('#notices li:has-text("The position is occupied")');
  expect(await count()).toBe(before + 1);
});

it('adds a shape from a file, and refuses a file without one', async () => {
  await visit('rigid-stack');
  const { page } = visits.viewer;
  const before = await count();
  const load = (name: string, text: string): Promise<void> =>
    page.setInputFiles('#add-file', { name, mimeType: 'text/plain', buffer: Buffer.from(text) });
  await load('none.obj', 'no triangles');
  await page.waitForSelector('#notices li:has-text("no triangles")');
  const octahedron = [
    'v 3 0 0\nv -3 0 0\nv 0 3 0\nv 0 -3 0\nv 0 0 3\nv 0 0 -3',
    'f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6',
  ].join('\n');
  await page.selectOption('#add-kind', 'rigid');
  await page.locator('#add-shape').evaluate((picker: HTMLSelectElement) => {
    picker.value = 'mesh';
  });
  await load('octahedron.obj', octahedron);
  await page.fill('#add-size', '0.3');
  await page.click('#add-place:enabled');
  await place('ArrowLeft', 'Enter');
  await expect.poll(count, kInTime).toBe(before + 1);
  const { positions } = (await bodies()).at(-1)!;
  // A sixth of the surrounding cube. Surface particles count completely or not at all.
  const { bodies: made } = await visits.scene();
  const expected = 0.3 ** 3 / 6 / made.at(-1)!.spacing! ** 3;
  expect(positions.length / expected).toBeGreaterThan(0.5);
  expect(positions.length / expected).toBeLessThan(2);
});

it('deletes a body, restores it, and changes its material', async () => {
  await visit('buoyancy', 20);
  const { page } = visits.viewer;
  const item = page.locator('#bodies li:has(select)').first();
  const before = await visits.observer.body(Number(await item.getAttribute('data-body')));
  await item.locator('button:has-text("Delete")').click();
  await expect.poll(names, kInTime).not.toContain(before.name);
  await page.click('#undo:enabled');
  await expect.poll(names, kInTime).toContain(before.name);
  const back = (await bodyOf(before.name))!;
  expect(Math.hypot(...before.velocities[0]!)).toBeGreaterThan(0.1);
  for (const axis of [0, 1, 2]) {
    expect(back.center_of_mass![axis]).toBeCloseTo(before.center_of_mass![axis]!, 6);
    expect(back.velocities[0]![axis]).toBeCloseTo(before.velocities[0]![axis]!, 6);
  }
  const picker = page.locator(`#bodies select[aria-label="Material of ${before.name}"]`);
  await expect.poll(() => picker.count(), kInTime).toBe(1);
  const now = await picker.inputValue();
  const other = (await picker.locator('option').allTextContents()).find((name) => name !== now)!;
  await picker.selectOption(other);
  const material = async (): Promise<string | undefined> =>
    (await visits.observer.request('session.join', {})).description.bodies.find(
      ({ name }) => name === before.name,
    )?.material;
  await expect.poll(material, kInTime).toBe(other);
  await page.click('#undo:enabled');
  await expect.poll(material, kInTime).toBe(now);
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

it('moves a body to a free place but not into others, and undoes it', async () => {
  await visit({
    format: 'vat.scene/1',
    name: 'long',
    materials: [{ name: 'wood', density: 600 }],
    vat: { min: [0, 0, 0], max: [1.6, 0.6, 1.2] },
    bodies: [plank, ball],
  });
  const { viewer } = visits;
  const move = '#bodies li:has-text("plank") button:has-text("Move")';
  const at = async (): Promise<readonly number[]> => (await bodyOf('plank'))!.center_of_mass!;
  const height = async (): Promise<number> => (await at())[2]!;
  const before = await at();
  await viewer.page.click(move);
  await place('ArrowLeft', 'ArrowLeft', 'Enter'); // below the top, 35 cm above the ball
  await expect.poll(height, kInTime).toBeGreaterThan(1.1);
  expect(Math.hypot((await at())[0]! - before[0]!, (await at())[1]! - before[1]!)).toBeGreaterThan(
    0.05,
  );
  await viewer.until('#view:not([data-placing])');
  await viewer.page.click(move);
  // 7 or 8 steps of 4 % of 1.2 m, into the ball.
  await place(...Array<string>(7).fill('ArrowDown'), 'Enter');
  await viewer.page.waitForSelector('#notices li:has-text("The position is occupied")');
  expect(await height()).toBeGreaterThan(1.1);
  await viewer.page.keyboard.press('Escape');
  await viewer.page.click('#undo:enabled');
  const moved = async (): Promise<number> =>
    Math.hypot(...(await at()).map((x, axis) => x - before[axis]!));
  await expect.poll(moved, kInTime).toBeLessThan(1e-6);
});
