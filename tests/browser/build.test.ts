import { expect, it } from 'vitest';
import type { BodyState } from '../../web/client/index';
import { Visits } from './visits';

/** A scene is built: bodies are added where one points, made anew, deleted, and all of it undone. */
const visits = new Visits();

const kInTime = { timeout: 120_000, interval: 200 };

async function visit(scene: string): Promise<void> {
  await visits.visit(scene);
  await visits.viewer.page.click('#build-details > summary');
  await visits.viewer.page.waitForSelector('#bodies li[data-body]');
}

async function bodies(): Promise<BodyState[]> {
  return (await visits.observer.request('state.query', {})).bodies;
}

const names = async (): Promise<string[]> => (await bodies()).map(({ name }) => name);

async function choose(kind: string, shape: string, centimetres: number): Promise<void> {
  await visits.viewer.page.selectOption('#add-kind', kind);
  await visits.viewer.page.selectOption('#add-shape', shape);
  await visits.viewer.page.fill('#add-size', String(centimetres / 100));
  await visits.viewer.page.waitForSelector('#add-place:enabled');
}

/** In shares of the canvas. */
async function putAt(across: number, down: number): Promise<void> {
  const box = (await visits.viewer.page.locator('#view').boundingBox())!;
  await visits.viewer.page.mouse.click(box.x + across * box.width, box.y + down * box.height);
}

it.each([
  ['rigid', 'box', 12],
  ['deformable', 'sphere', 20],
  ['liquid', 'sphere', 20],
] as const)(
  'adds a body that is %s where one clicks, takes it back and adds it again',
  async (kind, shape, size) => {
    await visit('sliding-vat-liquid');
    const block = (await bodies()).find(({ name }) => name === 'jelly block')!;
    await visits.observer.request('world.remove_body', { body: block.body });
    await visits.viewer.page.waitForSelector('#bodies:not(:has-text("jelly block"))');
    await visits.viewer.until('#view[data-tick]');
    const before = await names();
    await choose(kind, shape, size);
    await visits.viewer.page.click('#add-place');
    await visits.viewer.until('#view[data-placing]');
    await putAt(0.3, 0.38); // where the block was
    await expect.poll(async () => (await names()).length, kInTime).toBe(before.length + 1);
    await visits.viewer.until('#view:not([data-placing])');
    const added = (await bodies()).at(-1)!;
    expect(added.kind).toBe(kind);
    const middle = [0, 1, 2].map(
      (axis) =>
        added.positions.reduce((sum, place) => sum + place[axis]!, 0) / added.positions.length,
    );
    const { vat } = (await visits.observer.request('session.join', {})).description;
    const across = (middle[0]! - vat!.min[0]) / (vat!.max[0] - vat!.min[0]);
    expect(across).toBeLessThan(0.5); // to the left, and high
    expect(middle[2]!).toBeGreaterThan(vat!.min[2] + 0.4 * (vat!.max[2] - vat!.min[2]));
    const told = Number(
      /About (\d+)/.exec((await visits.viewer.page.textContent('#add-note')) ?? '')?.[1],
    );
    expect(told / added.positions.length).toBeGreaterThan(0.5);
    expect(told / added.positions.length).toBeLessThan(2);
    await visits.viewer.page.click('#undo');
    await expect.poll(names, kInTime).toEqual(before);
    await visits.viewer.page.keyboard.press('Control+y');
    await expect.poll(async () => (await names()).length, kInTime).toBe(before.length + 1);
    await visits.viewer.page.waitForSelector('#undo:enabled');
    await visits.viewer.page.keyboard.press('Control+z');
    await expect.poll(names, kInTime).toEqual(before);
  },
);

it('places by keys, and puts nothing where there is something', async () => {
  await visit('rigid-stack');
  const before = (await names()).length;
  await choose('rigid', 'sphere', 10);
  await visits.viewer.page.click('#add-place');
  await visits.viewer.until('#view[data-placing]');
  const { x, y } = await visits.viewer.page.evaluate(() => {
    const box = document.getElementById('view')!.getBoundingClientRect();
    return { x: box.x + box.width / 2, y: box.y + box.height / 2 };
  });
  await visits.viewer.page.mouse.move(x, y);
  for (let n = 0; n < 40; ++n) await visits.viewer.page.keyboard.press('ArrowDown'); // as far as it goes
  await visits.viewer.page.keyboard.press('Escape');
  await visits.viewer.until('#view:not([data-placing])');
  expect(await names()).toHaveLength(before);
  await visits.viewer.page.click('#add-place');
  await visits.viewer.page.keyboard.press('ArrowLeft');
  await visits.viewer.page.keyboard.press('Enter');
  await expect.poll(async () => (await names()).length, kInTime).toBe(before + 1);
  // Where the new one is, there is no room for another.
  await visits.viewer.page.waitForSelector(`#bodies li:nth-child(${before + 1})`);
  await visits.viewer.page.click('#add-place');
  await visits.viewer.page.keyboard.press('ArrowLeft');
  await visits.viewer.page.keyboard.press('Enter');
  await visits.viewer.page.waitForSelector('#notices li:has-text("There is something already")');
  expect(await names()).toHaveLength(before + 1);
});

it('adds a shape from a file, and says what is none', async () => {
  await visit('rigid-stack');
  const before = (await names()).length;
  const load = (name: string, text: string): Promise<void> =>
    visits.viewer.page.setInputFiles('#add-file', {
      name,
      mimeType: 'text/plain',
      buffer: Buffer.from(text),
    });
  await load('none.obj', 'no triangles');
  await visits.viewer.page.waitForSelector('#notices li:has-text("no triangles")');
  const octahedron = [
    'v 3 0 0\nv -3 0 0\nv 0 3 0\nv 0 -3 0\nv 0 0 3\nv 0 0 -3',
    'f 1 3 5\nf 3 2 5\nf 2 4 5\nf 4 1 5\nf 3 1 6\nf 2 3 6\nf 4 2 6\nf 1 4 6',
  ].join('\n');
  await visits.viewer.page.selectOption('#add-kind', 'rigid');
  await visits.viewer.page.locator('#add-shape').evaluate((picker: HTMLSelectElement) => {
    picker.value = 'mesh';
  });
  await load('octahedron.obj', octahedron);
  await visits.viewer.page.fill('#add-size', '0.3');
  await visits.viewer.page.waitForSelector('#add-place:enabled');
  await visits.viewer.page.click('#add-place');
  await visits.viewer.page.keyboard.press('ArrowLeft');
  await visits.viewer.page.keyboard.press('Enter');
  await expect.poll(async () => (await names()).length, kInTime).toBe(before + 1);
  const { positions } = (await bodies()).at(-1)!;
  // A sixth of the cube around it; particles of its surface count as a whole or not at all.
  const { bodies: made } = await visits.scene();
  const expected = 0.3 ** 3 / 6 / made.at(-1)!.spacing! ** 3;
  expect(positions.length / expected).toBeGreaterThan(0.5);
  expect(positions.length / expected).toBeLessThan(2);
});

it('deletes a body, brings it back where it was, and makes one of another material', async () => {
  await visit('buoyancy');
  const item = visits.viewer.page.locator('#bodies li:has(select)').first();
  const id = Number(await item.getAttribute('data-body'));
  const before = await visits.observer.body(id);
  await item.locator('button:has-text("Delete")').click();
  await expect.poll(names, kInTime).not.toContain(before.name);
  await visits.viewer.page.click('#undo');
  await expect.poll(names, kInTime).toContain(before.name);
  const found = async (): Promise<BodyState> =>
    (await bodies()).find(({ name }) => name === before.name)!;
  const back = await found();
  for (const axis of [0, 1, 2]) {
    expect(back.center_of_mass![axis]).toBeCloseTo(before.center_of_mass![axis]!, 6);
  }
  const picker = visits.viewer.page.locator(
    `#bodies select[aria-label="Material of ${before.name}"]`,
  );
  await expect.poll(() => picker.count(), kInTime).toBe(1);
  const now = await picker.inputValue();
  const others = await picker.locator('option').allTextContents();
  const other = others.find((name) => name !== now)!;
  await picker.selectOption(other);
  const material = async (): Promise<string | undefined> =>
    (await visits.observer.request('session.join', {})).description.bodies.find(
      ({ name }) => name === before.name,
    )?.material;
  await expect.poll(material, kInTime).toBe(other);
  await visits.viewer.page.click('#undo');
  await expect.poll(material, kInTime).toBe(now);
});

it('moves a body to where one clicks, and back', async () => {
  await visit('rigid-stack');
  const item = visits.viewer.page.locator('#bodies li[data-body]').first();
  const id = Number(await item.getAttribute('data-body'));
  const place = async (): Promise<readonly number[]> =>
    (await visits.observer.body(id)).center_of_mass!;
  const before = await place();
  await item.locator('button:has-text("Move")').click();
  await visits.viewer.until('#view[data-placing]');
  await visits.viewer.page.keyboard.press('ArrowLeft');
  await visits.viewer.page.keyboard.press('ArrowLeft');
  await visits.viewer.page.keyboard.press('Enter');
  const moved = async (): Promise<number> =>
    Math.hypot(...(await place()).map((x, axis) => x - before[axis]!));
  await expect.poll(moved, kInTime).toBeGreaterThan(0.1);
  await visits.viewer.page.waitForSelector('#undo:enabled');
  await visits.viewer.page.click('#undo');
  await expect.poll(moved, kInTime).toBeLessThan(1e-6);
});

it('changes the constants of a material, within their range, and back', async () => {
  await visit('dam-break');
  await visits.viewer.page.click('#parameters-details > summary');
  const viscosity = async (): Promise<number | undefined> => {
    const { materials } = await visits.scene();
    return materials.find(({ liquid }) => liquid)?.liquid?.viscosity;
  };
  const before = (await viscosity())!;
  const field = visits.viewer.page.locator('#material-liquid-viscosity');
  await field.fill(String(before + 3));
  await field.press('Enter');
  await expect.poll(viscosity, kInTime).toBe(before + 3);
  await visits.viewer.page.click('button[aria-label="Viscosity as it was"]');
  await expect.poll(viscosity, kInTime).toBe(before);
  await field.fill('-1');
  await field.press('Enter');
  await visits.viewer.page.waitForSelector(
    '.parameter:has(#material-liquid-viscosity) .fault:has-text("from 0 to")',
  );
  expect(await viscosity()).toBe(before);
  await expect.poll(() => field.inputValue(), kInTime).toBe(String(before));
});

it('slides the vat by hand, which goes back once it is let go', async () => {
  await visit('dam-break');
  await visits.viewer.page.click('#parameters-details > summary');
  await visits.viewer.page.locator('#slide').scrollIntoViewIfNeeded();
  const pad = (await visits.viewer.page.locator('#slide').boundingBox())!;
  const highest = async (): Promise<number> => {
    const { positions } = (await bodies()).find(({ kind }) => kind === 'liquid')!;
    return Math.max(...positions.map(([x]) => x));
  };
  const { vat } = (await visits.observer.request('session.join', {})).description;
  await visits.viewer.page.mouse.move(pad.x + pad.width / 2, pad.y + pad.height / 2);
  await visits.viewer.page.mouse.down();
  await visits.viewer.page.mouse.move(pad.x + pad.width - 2, pad.y + pad.height / 2, { steps: 4 });
  const offset = async (): Promise<number> => {
    await visits.observer.request('control.step', { ticks: 50 });
    return (await highest()) - vat!.max[0];
  };
  // The walls have taken the liquid beyond where the vat was.
  await expect.poll(offset, kInTime).toBeGreaterThan(0.05);
  await visits.viewer.page.mouse.up();
  await expect.poll(offset, kInTime).toBeLessThan(0.01);
});
