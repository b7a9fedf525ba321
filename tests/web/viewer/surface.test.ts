import { describe, expect, it } from 'vitest';
import { fieldAround } from '../../../web/viewer/view/surface/field';
import { marchingCubes } from '../../../web/viewer/view/surface/marching_cubes';
import type { Surface } from '../../../web/viewer/view/surface/marching_cubes';
import { openEdges, volumeOf } from '../mesh';
import type { Mesh } from '../mesh';

function meshOf({ positions, indices }: Surface): Mesh {
  return { vertices: positions, triangles: indices };
}

/** Returns a generator of numbers from 0 to 1 that is the same in every run. */
function numbers(seed: number): () => number {
  let state = seed;
  return () => (state = (Math.imul(state, 1664525) + 1013904223) >>> 0) / 2 ** 32;
}

describe('marchingCubes', () => {
  it('is closed and turned outward whatever the field', () => {
    const next = numbers(7);
    for (let run = 0; run < 20; ++run) {
      const distances = new Float32Array(9 * 8 * 7).map((_, n) => {
        const [x, y, z] = [n % 9, Math.floor(n / 9) % 8, Math.floor(n / 72)];
        const isEdge = x === 0 || y === 0 || z === 0 || x === 8 || y === 7 || z === 6;
        return isEdge ? 1 : next() - 0.5;
      });
      const surface = marchingCubes({
        size: [9, 8, 7],
        origin: [0, 0, 0],
        step: 1,
        distances,
        values: undefined,
      });
      expect(surface.indices.length).toBeGreaterThan(300);
      expect(openEdges(meshOf(surface))).toBe(0);
      expect(volumeOf(meshOf(surface))).toBeGreaterThan(0);
    }
  });
});

describe('fieldAround', () => {
  it('gives one particle a sphere of its radius', () => {
    const surface = marchingCubes(fieldAround([100, 200, 300], 5));
    expect(openEdges(meshOf(surface))).toBe(0);
    const distances = surface.positions.reduce<number[]>((all, _, i, p) => {
      if (i % 3 === 0) all.push(Math.hypot(p[i]! - 100, p[i + 1]! - 200, p[i + 2]! - 300));
      return all;
    }, []);
    // Linear interpolation between two nodes at a distance h has an error of at most h^2/8 over the
    // radius.
    for (const distance of distances) expect(Math.abs(distance - 5)).toBeLessThan(5 / 8);
  });

  it('gives a block of particles its volume, flat sides and the mean of values', () => {
    const radius = 0.5; // particles a metre apart
    const places = Array.from({ length: 512 }, (_, i) => [i & 7, (i >> 3) & 7, i >> 6]).flat();
    const values = Array.from({ length: 512 }, (_, i) => ((i & 7) < 4 ? 1 : 3));
    const surface = marchingCubes(fieldAround(places, radius, values));
    expect(openEdges(meshOf(surface))).toBe(0);
    const volume = volumeOf(meshOf(surface));
    // Corners and edges are rounded, and sides move inwards by the mean of inner neighbours.
    expect(volume).toBeGreaterThan(0.6 * 512);
    expect(volume).toBeLessThan(512);
    const { positions, normals } = surface;
    let [top, count] = [0, 0];
    for (let i = 0; i < positions.length; i += 3) {
      const isOnTop =
        positions[i + 2]! > 6.5 && [0, 1].every((q) => Math.abs(positions[i + q]! - 3.5) < 2);
      if (!isOnTop) continue;
      top += normals[i + 2]!;
      ++count;
    }
    expect(count).toBeGreaterThan(20);
    expect(top / count).toBeGreaterThan(0.98); // outwards and nearly flat
    expect(Math.min(...surface.values!)).toBeGreaterThanOrEqual(1);
    expect(Math.max(...surface.values!)).toBeLessThanOrEqual(3.001);
  });
});
