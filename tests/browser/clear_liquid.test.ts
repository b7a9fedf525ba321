import { afterAll, describe, expect, it } from 'vitest';
import type { Scene } from '../../web/client/index';
import {
  cornerGap,
  deepestDent,
  downward,
  maskOf,
  meanChange,
  normalDeviation,
  outlineOf,
  unroundness,
} from './support/liquid_shape';
import type { Mask } from './support/liquid_shape';
import { fullPixelsOf } from './support/pixels';
import { kInTime, Visits } from './support/visits';

/** The drawn surface of clear liquids, measured in pictures of 960 × 600 pixels. */
const visits = new Visits();
const kLook = { viewport: { width: 960, height: 600 }, deviceScaleFactor: 1, hasBar: true };

const figures: string[] = [];
afterAll(() => void process.stdout.write(`${figures.join('\n')}\n`));

function note(name: string, value: number, unit: string): number {
  figures.push(`${name}: ${Number(value.toPrecision(3))} ${unit}`);
  return value;
}

type Liquid = NonNullable<Scene['bodies'][number]['shape']>;

/** A scene with one body of water. */
function sceneOf(
  name: string,
  shape: Liquid,
  spacing: number,
  size: [number, number, number],
): Scene {
  return {
    format: 'vat.scene/1',
    name,
    materials: [
      {
        name: 'water',
        density: 1000,
        liquid: {
          stiffness: 400,
          viscosity: 0.1,
          support_radius: 2 * spacing,
          artificial_viscosity: 0.1,
        },
      },
    ],
    vat: { min: [0, 0, 0], max: size },
    numerics: { integrator: 'velocity_verlet', step: spacing / 16, tick: 0.02 },
    bodies: [{ name: 'water', kind: 'liquid', material: 'water', spacing, shape }],
  };
}

const kPool = sceneOf(
  'pool',
  { type: 'box', center: [0.8, 0.4, 0.1], size: [1.6, 0.8, 0.2] },
  0.04,
  [1.6, 0.8, 0.4],
);
/** Regions of its picture: the surface away from the walls, and the water behind the front wall. */
const kSurface = { left: 0.47, top: 0.31, right: 0.6, bottom: 0.36 };
const kFront = { left: 0.3, top: 0.46, right: 0.6, bottom: 0.49 };
/** A sheet of 10 000 particles that runs along the vat. */
const kSpacing = 0.02;
const kSheet = sceneOf(
  'sheet',
  { type: 'box', center: [0.2, 0.25, 0.2], size: [0.4, 0.5, 0.4] },
  kSpacing,
  [1.6, 0.5, 0.6],
);
/** A column of liquid stands on a pool. */
const kColumn: Scene = (() => {
  const scene = sceneOf(
    'column',
    { type: 'box', center: [0.8, 0.4, 0.1], size: [1.6, 0.8, 0.2] },
    0.04,
    [1.6, 0.8, 0.8],
  );
  const { bodies } = scene;
  const shape: Liquid = { type: 'box', center: [0.8, 0.24, 0.42], size: [0.2, 0.2, 0.44] };
  return { ...scene, bodies: [...bodies, { ...bodies[0]!, name: 'column', shape }] };
})();
/** The region of its picture where the outlines of column and pool meet. */
const kFoot = { left: 0.3, top: 0.25, right: 0.66, bottom: 0.6 };
const kDrop = sceneOf(
  'drop',
  { type: 'sphere', center: [0.5, 0.5, 0.6], radius: 0.24 },
  0.02,
  [1, 1, 1],
);

async function show(scene: Scene, ticks: number, view: string): Promise<void> {
  // Particles are drawn faster while the scene runs.
  await visits.visit(scene, { ...kLook, view: 'liquid:particles' });
  for (let done = 0; done < ticks; done += 10) {
    await visits.observer.request('control.step', { ticks: Math.min(10, ticks - done) });
  }
  await visits.viewer.untilTick(ticks, ticks);
  await visits.untilWhole();
  await visits.set(view);
}

/** Moves the camera to the preset of a key. */
async function viewFrom(key: string): Promise<void> {
  const { page } = visits.viewer;
  await page.emulateMedia({ reducedMotion: 'reduce' }); // the camera does not fly
  const before = await visits.viewer.picture();
  await page.keyboard.press(key);
  const moved = async (): Promise<number> =>
    visits.viewer.difference(before, await visits.viewer.picture());
  await expect.poll(moved, kInTime).toBeGreaterThan(0);
}

/** Returns the pixels of the liquid. */
async function mask(): Promise<Mask> {
  await visits.set('liquid:fluid,colour:normals');
  const normals = await fullPixelsOf(visits.viewer);
  await visits.set('liquid:fluid,colour:material');
  return maskOf(normals, await fullPixelsOf(visits.viewer));
}

describe('a pool at rest', () => {
  it('has a level surface away from walls, and a flat face at a wall', async () => {
    await show(kPool, 150, 'liquid:fluid,colour:normals');
    const normals = await fullPixelsOf(visits.viewer);
    const deviation = normalDeviation(normals, kSurface, [0, 0, 1]);
    expect(note('normals of a pool', deviation, '° RMS')).toBeLessThan(2);
    // The angle of the colour's rounding error is 0.4°.
    const atWall = normalDeviation(normals, kFront, [0, -1, 0]);
    expect(note('normals at a wall', atWall, '° RMS')).toBeLessThan(0.5);
  });

  it('is drawn with the same pixels while it is paused', async () => {
    await visits.set('liquid:fluid');
    const before = await fullPixelsOf(visits.viewer);
    await visits.set('liquid:particles');
    await visits.set('liquid:fluid');
    const after = await fullPixelsOf(visits.viewer);
    expect(note('change of a paused pool', meanChange(before, after), '')).toBe(0);
  });

  it('hardly changes between frames', async () => {
    await visits.set('liquid:fluid');
    const before = await fullPixelsOf(visits.viewer);
    const { tick } = await visits.observer.request('control.step', { ticks: 1 });
    await visits.viewer.untilTick(tick, tick);
    const after = await fullPixelsOf(visits.viewer);
    const change = note('change of a calm pool', 100 * meanChange(before, after), '%');
    expect(change).toBeGreaterThan(0);
    expect(change).toBeLessThan(0.5);
  });

  it('fills the corners of the front wall', async () => {
    await viewFrom('4');
    // Rounded over a particle diameter, a corner would lack 1 - π/4 of its square.
    const diameter = 0.04 / 1.6;
    const gap = note('gap in a corner', cornerGap(await mask(), diameter), 'of a particle square');
    expect(gap).toBeLessThan(0.1);
  });
});

it('draws a sheet of 10 000 particles without dents', async () => {
  await show(kSheet, 20, 'liquid:fluid');
  const shape = await mask();
  // The vat is 1.6 m wide and fills at most the width of the picture.
  const spacing = (kSpacing / 1.6) * (shape.width / 1.08);
  const dent = deepestDent(outlineOf(shape), 4 * spacing) / spacing;
  expect(note('deepest dent of a sheet', dent, 'spacings')).toBeLessThan(0.5);
});

it('draws no overhang where a column meets a pool behind it', async () => {
  await show(kColumn, 6, 'liquid:fluid,colour:normals');
  const pixels = await fullPixelsOf(visits.viewer);
  expect(note('normals that point down', downward(pixels, kFoot), 'pixels')).toBeLessThan(200);
});

it('draws a falling drop round', async () => {
  await show(kDrop, 8, 'liquid:fluid');
  await viewFrom('4');
  const difference = 100 * unroundness(await mask());
  expect(note('diameters of a drop', difference, '% from the mean')).toBeLessThan(2);
});
