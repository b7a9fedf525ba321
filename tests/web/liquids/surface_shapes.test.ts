import { describe, expect, it } from 'vitest';
import {
  SurfaceShapes,
  kMostShape,
  kMostShaped,
  kMostShift,
  kShapeNumbers,
  kSphere,
} from '../../../web/viewer/view/fluid/surface_shapes';

const kRadius = 10;
/** Particles of a lattice are two radii apart. */
const kSpacing = 2 * kRadius;
const kFar = 1e6;
const kNoWalls = { low: [-kFar, -kFar, -kFar], high: [kFar, kFar, kFar] };
/** Rounding errors of the packed numbers. */
const kDigits = 2;

type Place = readonly [number, number, number];

interface Shape {
  /** Semi-axes along the coordinate axes [radii]. */
  axes: number[];
  /** The entries xy, xz and yz. */
  mixed: number[];
  /** Displacement [radii]. */
  shift: number[];
}

/** Returns the places of a lattice with this number of particles along each axis. */
function lattice([nx, ny, nz]: Place): Place[] {
  return Array.from({ length: nx * ny * nz }, (_, i) => [
    kSpacing * (i % nx),
    kSpacing * (Math.floor(i / nx) % ny),
    kSpacing * Math.floor(i / (nx * ny)),
  ]);
}

/** Reads a shape as the shader does. */
function unpack(values: Uint32Array): Shape {
  const half = (bits: number): number => (kMostShape * ((bits << 16) >> 16)) / 32767;
  const [xx, yy, zz, xy, xz, yz] = [0, 1, 2].flatMap((n) => [
    half(values[n]!),
    half(values[n]! >>> 16),
  ]) as [number, number, number, number, number, number];
  const way = (q: number): number => ((values[3]! >>> (10 * q)) & 1023) - 512;
  return {
    axes: [xx, yy, zz],
    mixed: [xy, xz, yz],
    shift: [0, 1, 2].map((q) => (kMostShift * way(q)) / 511),
  };
}

/** Returns the shape of each particle of a liquid. Particles of solids have the weight 1. */
function shapesOf(
  places: readonly Place[],
  walls = kNoWalls,
  solids: readonly Place[] = [],
): Shape[] {
  const values = new Uint32Array(kShapeNumbers * places.length);
  const all = [...places, ...solids].flat();
  const weights = solids.map(() => 1);
  new SurfaceShapes().write(all, places.length, weights, kRadius, walls, values);
  return places.map((_, i) => unpack(values.subarray(kShapeNumbers * i, kShapeNumbers * (i + 1))));
}

function indexOf(places: readonly Place[], [x, y, z]: Place): number {
  return places.findIndex((p) => p[0] === x && p[1] === y && p[2] === z);
}

describe('a block of liquid', () => {
  const kSide = 13;
  const kMiddle = kSpacing * 6;
  const kTop = kSpacing * (kSide - 1);
  const places = lattice([kSide, kSide, kSide]);
  const shapes = shapesOf(places);

  it('has spheres within', () => {
    const { axes, shift } = shapes[indexOf(places, [kMiddle, kMiddle, kMiddle])]!;
    for (const axis of axes) expect(axis).toBeCloseTo(kSphere, 1);
    for (const way of shift) expect(way).toBeCloseTo(0, kDigits);
  });

  it('has flat ellipsoids at a face, which stay in its plane', () => {
    const { axes, mixed, shift } = shapes[indexOf(places, [kMiddle, kMiddle, kTop])]!;
    expect(axes[2]! / axes[0]!).toBeLessThan(0.75);
    expect(axes[1]).toBeCloseTo(axes[0]!, kDigits);
    for (const entry of mixed) expect(entry).toBeCloseTo(0, kDigits);
    for (const way of shift) expect(way).toBeCloseTo(0, kDigits);
  });
});

it('moves a particle that protrudes from a face towards the face', () => {
  const places = lattice([13, 13, 7]).map((place): Place => [...place]);
  const i = indexOf(places, [6 * kSpacing, 6 * kSpacing, 6 * kSpacing]);
  const [x, y, z] = places[i]!;
  places[i] = [x, y, z + 0.6 * kRadius];
  const { shift } = shapesOf(places)[i]!;
  expect(shift[2]).toBeLessThan(-0.25);
  expect(shift[2]).toBeGreaterThan(-0.6);
  for (const way of shift.slice(0, 2)) expect(way).toBeCloseTo(0, kDigits);
});

it.each([
  ['a sheet', [13, 13, 1], [false, false, true]],
  ['a thread', [13, 1, 1], [false, true, true]],
  ['a single particle', [1, 1, 1], [true, true, true]],
] as const)('makes %s thin where it has no neighbours', (_, size, isThin) => {
  const places = lattice(size);
  const middle = size.map((n) => kSpacing * Math.floor(n / 2)) as unknown as Place;
  const { axes } = shapesOf(places)[indexOf(places, middle)]!;
  axes.forEach((axis, q) => {
    if (isThin[q]) expect(axis).toBeLessThan(1);
    else expect(axis).toBeGreaterThan(1.2);
  });
});

it('has the same shapes at a wall as away from it', () => {
  const places = lattice([13, 13, 7]);
  const walls = { low: [-kRadius, -kFar, -kRadius], high: [kFar, kFar, kFar] };
  const shapes = shapesOf(places, walls);
  const away = shapes[indexOf(places, [6 * kSpacing, 6 * kSpacing, 6 * kSpacing])]!;
  const beside = shapes[indexOf(places, [0, 6 * kSpacing, 6 * kSpacing])]!;
  beside.axes.forEach((axis, q) => expect(axis).toBeCloseTo(away.axes[q]!, kDigits));
  const below = shapes[indexOf(places, [0, 6 * kSpacing, 0])]!;
  for (const axis of below.axes) expect(axis).toBeCloseTo(kSphere, 1);
});

describe('a liquid beside a solid', () => {
  const kUnseen = 0.02; // one hundredth of a spacing
  const kSide = 13;
  const kMiddle = kSpacing * 6;
  const liquid = lattice([kSide, kSide, 6]);
  const [, , kTop] = liquid.at(-1)!;
  /** Returns a solid whose surface is at this distance above the particles at the top [radii]. */
  const solidAt = (distance: number): Place[] =>
    lattice([kSide, kSide, 5]).map(([x, y, z]) => [x, y, z + kTop + (distance + 1) * kRadius]);
  const shapeAt = (z: number, solids: readonly Place[]): Shape =>
    shapesOf(liquid, kNoWalls, solids)[indexOf(liquid, [kMiddle, kMiddle, z])]!;

  it.each([1, 1.25, 1.5])('extends to its surface at a distance of %f radii', (distance) => {
    const { axes, shift } = shapeAt(kTop, solidAt(distance));
    expect(shift[2]! + axes[2]!).toBeGreaterThan(distance);
    for (const way of shift.slice(0, 2)) expect(Math.abs(way)).toBeLessThan(kUnseen);
  });

  it('does not extend from its other side, nor to a distant solid', () => {
    const alone = shapeAt(0, []);
    for (const [z, distance] of [
      [0, 1],
      [kTop, 5],
    ] as const) {
      const { axes, shift } = shapeAt(z, solidAt(distance));
      axes.forEach((axis, q) => expect(axis).toBeCloseTo(alone.axes[q]!, kDigits));
      shift.forEach((way, q) => expect(way).toBeCloseTo(alone.shift[q]!, kDigits));
    }
  });
});

it('does not move a single particle towards a wall', () => {
  const walls = { ...kNoWalls, low: [-kFar, -0.9 * kRadius, -kFar] };
  const { axes, shift } = shapesOf([[0, 0, 0]], walls)[0]!;
  for (const way of shift) expect(way).toBeCloseTo(0, kDigits);
  for (const axis of axes) expect(axis).toBeLessThan(1);
});

it('makes no shapes of no particles', () => {
  expect(shapesOf([])).toEqual([]);
});

it('keeps spheres if there are many', () => {
  const size: Place = [kMostShaped / 200, 100, 2];
  for (const [places, isShaped] of [
    [lattice(size), true],
    [[...lattice(size), [0, 0, 4 * kSpacing] as Place], false],
  ] as const) {
    expect(places.length > kMostShaped).toBe(!isShaped);
    const [, , height] =
      shapesOf(places)[indexOf(places, [100 * kSpacing, 50 * kSpacing, 0])]!.axes;
    expect(Math.abs(height! - kSphere) > 0.01).toBe(isShaped);
  }
});
