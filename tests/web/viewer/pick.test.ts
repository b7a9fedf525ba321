import { describe, expect, it } from 'vitest';
import { nearestSphere } from '../../../web/viewer/view/base/pick';

const kAlongX = { origin: { x: 0, y: 0, z: 0 }, direction: { x: 1, y: 0, z: 0 } };

describe('nearestSphere', () => {
  it('finds the first sphere on the ray, and the point', () => {
    const centers = [9, 0, 0, 5, 0.3, 0, 7, 0, 0];
    const hit = nearestSphere(kAlongX, centers, 0.5);
    expect(hit?.particle).toBe(1);
    expect(hit?.distance).toBeCloseTo(5 - 0.4, 12);
  });

  it('counts from the surface: a near miss of the centre may lie behind a full hit', () => {
    expect(nearestSphere(kAlongX, [5, 0.49, 0, 5.2, 0, 0], 0.5)?.particle).toBe(1);
  });

  it('passes by spheres beside and behind', () => {
    expect(nearestSphere(kAlongX, [5, 0.51, 0, -5, 0, 0, 5, 0, -0.6], 0.5)).toBeUndefined();
    expect(nearestSphere(kAlongX, [], 0.5)).toBeUndefined();
  });

  it('reads integers of a frame in their own units', () => {
    const line = { origin: { x: 100, y: 100, z: -1e5 }, direction: { x: 0, y: 0, z: 1 } };
    const centers = new Uint16Array([0, 0, 0, 130, 100, 40000]);
    expect(nearestSphere(line, centers, 50)).toEqual({ particle: 1, distance: 139960 });
  });
});
