import { Box3, Matrix4, Vector3 } from 'three';
import { expect, it } from 'vitest';
import { solidsNear } from '../../../web/viewer/view/fluid/solid_neighbours';

/** A grid with a quantum of 0.01 m and the origin (1, 2, 3) m. */
const kFromWorld = new Matrix4().makeScale(0.01, 0.01, 0.01).setPosition(1, 2, 3).invert();
/** A cube of liquid, 100 quanta wide, whose particles have a radius of 10 quanta: 0.1 m. */
const kLiquid = new Box3(new Vector3(0, 0, 0), new Vector3(100, 100, 100));
const kReach = 45;
const kRadius = 10;

/** Two particles at 0.5 m to both sides of a body's centre, along its x axis. */
const kBody = { places: [-0.5, 0, 0, 0.5, 0, 0], count: 2, radius: 0.1 };

it.each([
  ['beside the liquid', [1.7, 2.5, 3.5], [20, 50, 50, 120, 50, 50]],
  ['with one particle out of reach', [2, 2.5, 3.5], [50, 50, 50]],
  ['out of reach', [2, 4, 3.5], []],
] as const)('finds the particles of a body %s', (_, [x, y, z], places) => {
  const toWorld = new Matrix4().setPosition(x, y, z);
  const found = solidsNear([{ ...kBody, toWorld }], kFromWorld, kLiquid, kReach, kRadius);
  expect(found.places.length).toBe(places.length);
  found.places.forEach((place, n) => expect(place).toBeCloseTo(places[n]!, 9));
  expect(found.weights.length).toBe(places.length / 3);
  for (const weight of found.weights) expect(weight).toBeCloseTo(1, 9);
});

it.each([
  [0.2, 1],
  [0.1, 1],
  [0.05, 8],
  [0.06, 4],
])('weights particles with a radius of %f m by their volume, one of %i', (radius, every) => {
  const count = 40;
  const places = Array.from({ length: 3 * count }, () => 0);
  const toWorld = new Matrix4().setPosition(1.5, 2.5, 3.5);
  const body = { places, count, radius, toWorld };
  const { weights } = solidsNear([body], kFromWorld, kLiquid, kReach, kRadius);
  expect(weights.length).toBe(count / every);
  const volume = weights.reduce((sum, weight) => sum + weight, 0);
  expect(volume).toBeCloseTo(count * (radius / 0.1) ** 3, 9);
});
