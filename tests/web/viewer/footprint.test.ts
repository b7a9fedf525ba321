import { Vector3 } from 'three';
import { describe, expect, it } from 'vitest';
import { ballOf, blockOf, cloudOf } from '../../../web/viewer/view/base/footprint';

describe('the room that something takes', () => {
  it('of a ball', () => {
    const ball = ballOf(0.5);
    expect(ball.touches(new Vector3(0.59, 0, 0), 0.1)).toBe(true);
    expect(ball.touches(new Vector3(0.61, 0, 0), 0.1)).toBe(false);
    expect(ball.touches(new Vector3(0.4, 0.4, 0.4), 0.1)).toBe(false);
  });

  it('of a cube, to its corners', () => {
    const block = blockOf(1);
    expect(block.touches(new Vector3(0.4, 0.4, 0.4), 0.1)).toBe(true);
    expect(block.touches(new Vector3(0.56, 0.56, 0.5), 0.1)).toBe(true);
    expect(block.touches(new Vector3(0.58, 0.58, 0.5), 0.1)).toBe(false);
    expect(block.touches(new Vector3(0.61, 0, 0), 0.1)).toBe(false);
  });

  /** A rod of 2 m along x with 21 particles. */
  const rod = cloudOf(
    Array.from({ length: 21 }, (_, n) => new Vector3(n / 10 - 1, 0, 0)),
    0.05,
  );

  it('of particles: beside a long body there is room', () => {
    expect(rod.touches(new Vector3(0.95, 0.05, 0), 0.05)).toBe(true);
    expect(rod.touches(new Vector3(0.32, 0, 0.12), 0.05)).toBe(false);
    expect(rod.touches(new Vector3(1.2, 0, 0), 0.05)).toBe(false);
    expect(rod.touches(new Vector3(1.2, 0, 0), 0.3)).toBe(true); // a larger particle
    expect(rod.box.getSize(new Vector3()).toArray()).toEqual([2.1, 0.1, 0.1]);
  });

  it('of particles: as all of them tell one by one', () => {
    const places = Array.from(
      { length: 200 },
      (_, n) => new Vector3(Math.sin(n * 1.3), Math.cos(n * 2.1), Math.sin(n * 0.7 + 1)),
    );
    const cloud = cloudOf(places, 0.06);
    let touched = 0;
    for (let n = 0; n < 500; ++n) {
      const probe = new Vector3(Math.sin(n * 3.1), Math.cos(n * 0.9), Math.sin(n * 1.9));
      const expected = places.some((place) => place.distanceTo(probe) < 0.9 * (0.06 + 0.1));
      expect(cloud.touches(probe, 0.1)).toBe(expected);
      if (expected) touched += 1;
    }
    expect(touched).toBeGreaterThan(20);
    expect(touched).toBeLessThan(480);
  });
});
