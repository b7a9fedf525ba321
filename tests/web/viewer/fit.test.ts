import { Box3, PerspectiveCamera, Vector3 } from 'three';
import { describe, expect, it } from 'vitest';
import { BodiesBox, framedBox, Framing } from '../../../web/viewer/view/base/framed';
import { fitBox, nearestEye } from '../../../web/viewer/view/base/fit';
import type { Seen } from '../../../web/viewer/view/base/fit';
import { directionOf, firstDirection } from '../../../web/viewer/view/base/presets';

const kSide = 0.5;
const kRise = 0.3;

/** Returns the position of the outermost point on each side, relative to half the picture. */
function margins(points: Seen[], eye: Seen): Record<'right' | 'left' | 'up' | 'down', number> {
  const most = (value: (point: Seen, distance: number) => number): number =>
    Math.max(...points.map((point) => value(point, eye.back - point.back)));
  return {
    right: most((point, distance) => (point.right - eye.right) / (kSide * distance)),
    left: most((point, distance) => (eye.right - point.right) / (kSide * distance)),
    up: most((point, distance) => (point.up - eye.up) / (kRise * distance)),
    down: most((point, distance) => (eye.up - point.up) / (kRise * distance)),
  };
}

describe('nearestEye', () => {
  it('sees one square across the tighter axis', () => {
    const square = [-1, 1].flatMap((right) => [-1, 1].map((up) => ({ right, up, back: 0 })));
    const eye = nearestEye(square, kSide, kRise);
    expect(eye.right).toBeCloseTo(0, 12);
    expect(eye.up).toBeCloseTo(0, 12);
    expect(eye.back).toBeCloseTo(1 / kRise, 12);
  });

  it('touches both sides of the tighter axis and stays inside the other', () => {
    const points = [
      { right: 4, up: 0.2, back: 1 },
      { right: -3, up: 0.5, back: -2 },
      { right: 0, up: -0.4, back: 2 },
    ];
    const seen = margins(points, nearestEye(points, kSide, kRise));
    expect(seen.right).toBeCloseTo(1, 12);
    expect(seen.left).toBeCloseTo(1, 12);
    expect(seen.up).toBeLessThan(1);
    expect(seen.down).toBeLessThan(1);
  });
});

describe('firstDirection', () => {
  const directionTo = (width: number, depth: number): Vector3 =>
    firstDirection(new Box3(new Vector3(), new Vector3(width, depth, 1)));

  it.each([
    [1, 1],
    [2, 1],
    [1, 4],
    [0, 1],
  ])('is from the corner for %d m × %d m', (width, depth) => {
    expect(directionTo(width, depth).distanceTo(directionOf('corner'))).toBeLessThan(1e-12);
  });

  it('is nearer to the front for shallower scenes, and never exactly from the front', () => {
    const depths = [2, 1, 0.8, 0.4, 0];
    const turns = depths.map((depth) => -directionTo(2, depth).y);
    expect(turns).toEqual([...turns].sort((a, b) => a - b));
    for (const depth of depths) {
      const { x, z } = directionTo(2, depth);
      expect(Math.min(x, z)).toBeGreaterThan(0.1);
    }
  });
});

describe('the first view of a long scene', () => {
  it('is along it, so that its near end is larger', () => {
    const box = new Box3(new Vector3(), new Vector3(9, 0.1, 1));
    const from = firstDirection(box);
    const camera = new PerspectiveCamera(32, 16 / 9);
    camera.up.set(0, 0, 1);
    const { target, distance } = fitBox(box, from, camera, 1);
    const eye = target.addScaledVector(from, distance);
    expect(2 * eye.distanceTo(box.min)).toBeLessThan(eye.distanceTo(box.max));
  });

  it('is from the right if it is high or deep', () => {
    for (const size of [new Vector3(9, 0.1, 3), new Vector3(9, 3, 0.1)]) {
      expect(firstDirection(new Box3(new Vector3(), size)).x).toBeGreaterThan(0);
    }
  });
});

describe('framedBox', () => {
  const boxOf = (
    ...[x, y, z, toX, toY, toZ]: [number, number, number, number, number, number]
  ): Box3 => new Box3(new Vector3(x, y, z), new Vector3(toX, toY, toZ));
  const vat = boxOf(0, 0, 0, 10, 10, 5);

  it.each([
    ['a body', boxOf(0, 0, 0, 2, 10, 2), boxOf(0, 0, 0, 10, 10, 2.4)],
    ['a body below its top', boxOf(0, 0, 0, 10, 10, 4.8), vat],
    ['nothing', new Box3(), vat],
  ])('shows the part of a vat with %s', (_, contents, expected) => {
    const { min, max } = framedBox(vat, contents);
    expect([...min, ...max].map((value) => Number(value.toFixed(9)))).toEqual([
      ...expected.min,
      ...expected.max,
    ]);
  });
});

describe('BodiesBox', () => {
  const vat = new Box3(new Vector3(-5, -5, 0), new Vector3(5, 5, 10));
  const low = new Box3(new Vector3(-2, -2, 0), new Vector3(2, 2, 1));
  const high = new Box3(new Vector3(-1, -2, 4), new Vector3(4, 2, 9));

  it('contains the bodies at once, with space beside them and the floor below', () => {
    const room = new BodiesBox();
    for (const bodies of [low, high]) {
      room.follow(vat, bodies, 0.02);
      expect(room.box.containsBox(bodies)).toBe(true);
      expect(vat.containsBox(room.box)).toBe(true);
      expect(room.box.min.z).toBe(0);
      expect(room.box.max.x).toBeGreaterThan(bodies.max.x);
    }
  });

  it('shrinks to bodies that come together, in simulated time', () => {
    const room = new BodiesBox();
    room.follow(vat, high, 0);
    const first = room.box.max.z;
    room.follow(vat, low, 0);
    expect(room.box.max.z).toBe(first);
    const heights = [0.1, 0.1, 10].map((seconds) => {
      room.follow(vat, low, seconds);
      return room.box.max.z;
    });
    expect(heights).toEqual([...heights].sort((a, b) => b - a));
    expect(heights[0]).toBeLessThan(first);
    expect(heights[1]).toBeGreaterThan(5);
    expect(heights[2]).toBeCloseTo(1 + 0.08 * 10, 3);
  });

  it('is at least a quarter as wide as the vat', () => {
    const room = new BodiesBox();
    room.follow(vat, new Box3(new Vector3(), new Vector3(0.1, 0.1, 0.1)), 0);
    const { x, y } = room.box.getSize(new Vector3());
    expect(x).toBeCloseTo(2.5, 12);
    expect(y).toBeCloseTo(2.5, 12);
  });

  it('starts anew when time goes back', () => {
    const room = new BodiesBox();
    room.follow(vat, high, 0);
    room.follow(vat, low, -1);
    expect(room.box.max.z).toBeCloseTo(1.8, 12);
  });
});

describe('Framing', () => {
  const box = new Box3(new Vector3(), new Vector3(1, 1, 1));
  const larger = new Box3(new Vector3(), new Vector3(2, 2, 2));

  it('follows the box until the camera is moved', () => {
    const framing = new Framing();
    expect(framing.follow(new Box3())).toBe(false);
    expect(framing.box).toBeUndefined();
    expect([framing.follow(box), framing.follow(box), framing.follow(larger)]).toEqual([
      true,
      false,
      true,
    ]);
    framing.end();
    expect(framing.follow(box)).toBe(false);
    expect(framing.box).toBeUndefined();
  });

  it('frames a new scene whose first frame comes after a movement of the camera', () => {
    const framing = new Framing();
    framing.follow(box);
    framing.begin();
    framing.end(); // the orbit turns the camera before the first frame
    expect(framing.follow(larger)).toBe(true);
    expect(framing.box).toEqual(larger);
  });
});
