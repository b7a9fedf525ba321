import { Box3, Matrix4, Vector3 } from 'three';
import type { BufferGeometry } from 'three';
import { describe, expect, it } from 'vitest';
import type { SceneShape } from '../../../web/client/index';
import { BoundSurface, writeNormals } from '../../../web/viewer/view/solids/bound_surface';
import { Lattice } from '../../../web/viewer/view/solids/lattice';
import { geometryOf, segmentsOf } from '../../../web/viewer/view/solids/shape_geometry';
import { subdivide } from '../../../web/viewer/view/solids/subdivision';
import { hullOf } from '../../../web/viewer/view/solids/cell_hull';
import { openEdges, volumeOf } from '../mesh';
import type { Mesh } from '../mesh';

const kBox: SceneShape = { type: 'box', size: [0.4, 0.2, 0.3], center: [1, 2, 3] };
const kBall: SceneShape = { type: 'sphere', radius: 0.2, center: [0.1, 0, 0] };
const kCylinder: SceneShape = { type: 'cylinder', radius: 0.1, height: 0.5, axis: [2, 0, 0] };
const kTetrahedron: SceneShape = {
  type: 'mesh',
  vertices: [
    [0, 0, 0],
    [1, 0, 0],
    [0, 1, 0],
    [0, 0, 1],
  ],
  triangles: [
    [0, 2, 1],
    [0, 1, 3],
    [1, 2, 3],
    [0, 3, 2],
  ],
};

function meshOf(geometry: BufferGeometry): Mesh {
  const { array, count } = geometry.getAttribute('position');
  const triangles = geometry.index?.array ?? Array.from({ length: count }, (_, i) => i);
  return { vertices: array, triangles };
}

const corner = ({ vertices, triangles }: Mesh, i: number): Vector3 =>
  new Vector3().fromArray(vertices as number[], 3 * triangles[i]!);

/** Returns the centres of the cells of a block of this many cells, centred at a point. */
function block(count: readonly number[], spacing: number, middle = [0, 0, 0]): number[] {
  const places: number[] = [];
  for (let k = 0; k < count[2]!; ++k) {
    for (let j = 0; j < count[1]!; ++j) {
      for (let i = 0; i < count[0]!; ++i) {
        [i, j, k].forEach((at, q) =>
          places.push(middle[q]! + spacing * (at - (count[q]! - 1) / 2)),
        );
      }
    }
  }
  return places;
}

/** Returns the lattice points in a ball. */
function ball(radius: number, spacing: number, middle: readonly number[]): number[] {
  const width = Math.floor((2 * radius) / spacing);
  const all = block([width, width, width], spacing);
  const places: number[] = [];
  for (let i = 0; i < all.length; i += 3) {
    const place = all.slice(i, i + 3);
    if (Math.hypot(...place) <= radius) places.push(...place.map((x, q) => x + middle[q]!));
  }
  return places;
}

function bound(places: number[], spacing: number, shape: SceneShape): BoundSurface {
  return new BoundSurface(new Lattice(places, spacing), places, shape);
}

describe('The surface of a rigid body', () => {
  it.each([
    ['box', kBox, 0.024, [0.4, 0.2, 0.3]],
    ['sphere', kBall, (4 / 3) * Math.PI * 0.008, [0.4, 0.4, 0.4]],
    ['cylinder', kCylinder, Math.PI * 0.005, [0.5, 0.2, 0.2]],
    ['mesh', kTetrahedron, 1 / 6, [1, 1, 1]],
  ] as const)('has the size and the volume of its %s', (_, shape, volume, size) => {
    const geometry = geometryOf(shape)!;
    const ratio = volumeOf(meshOf(geometry)) / volume;
    expect(ratio).toBeGreaterThan(0.98); // bevels and facets
    expect(ratio).toBeLessThan(1.0001);
    const box = new Box3().setFromArray([...geometry.getAttribute('position').array]);
    box
      .getSize(new Vector3())
      .toArray()
      .forEach((x, q) => expect(x).toBeCloseTo(size[q]!, 3));
    const normals = geometry.getAttribute('normal');
    const mesh = meshOf(geometry);
    for (let i = 0; i < mesh.triangles.length; ++i) {
      const [a, b, c] = [0, 1, 2].map((n) => corner(mesh, i - (i % 3) + n));
      const face = b!.sub(a!).cross(c!.sub(a!));
      if (face.length() < 1e-9) continue; // at the ends of an axis
      const normal = new Vector3().fromBufferAttribute(normals, mesh.triangles[i]!);
      expect(normal.length()).toBeCloseTo(1, 5);
      expect(normal.dot(face.normalize())).toBeGreaterThan(0.8);
    }
  });

  it.each([
    ['box', kBox],
    ['sphere', kBall],
    ['cylinder', kCylinder],
  ] as const)('has fewer triangles for a %s whose details are not visible', (_, shape) => {
    const counts = [0, 1e-3, 1e-2].map((error) => {
      const geometry = geometryOf(shape, error)!;
      return (geometry.getIndex() ?? geometry.getAttribute('position')).count / 3;
    });
    expect(counts).toEqual([...counts].sort((a, b) => b - a));
    expect(counts[2]).toBeLessThan(0.3 * counts[0]!);
  });

  it.each([
    [0.2, 0.001],
    [0.2, 0.003],
    [0.02, 0.0005],
  ])('has segments of a circle of %d m that are within %d m of it', (radius, error) => {
    const sagitta = (segments: number): number => radius * (1 - Math.cos(Math.PI / segments));
    const segments = segmentsOf(radius, error);
    expect(sagitta(segments)).toBeLessThanOrEqual(error);
    expect(sagitta(segments - 4)).toBeGreaterThan(error);
  });

  it('has sharp edges between inclined faces of a mesh', () => {
    const normals = geometryOf(kTetrahedron)!.getAttribute('normal');
    const seen = new Set<string>();
    for (let i = 0; i < normals.count; ++i) {
      seen.add([normals.getX(i), normals.getY(i), normals.getZ(i)].map((x) => x.toFixed(3)).join());
    }
    expect(seen.size).toBe(4);
  });

  it('does not exist for single particles', () => {
    expect(geometryOf({ type: 'particles', positions: [[0, 0, 0]] })).toBeUndefined();
  });
});

describe('A subdivided cell', () => {
  it('is closed, with weights whose sum is 1', () => {
    const { corners, quads, isOuter } = hullOf(new Lattice([0, 0, 0], 1));
    expect(corners.length).toBe(8);
    const mesh = subdivide(corners.length, quads, isOuter);
    expect(mesh.count).toBe(8 + 12 + 6);
    expect(mesh.triangles.length).toBe(3 * 48);
    expect(openEdges(mesh)).toBe(0);
    for (let i = 0; i < mesh.count; ++i) {
      const row = mesh.weights.slice(mesh.begin[i], mesh.begin[i + 1]);
      expect(row.reduce((sum, weight) => sum + weight, 0)).toBeCloseTo(1, 6);
    }
  });
});

describe('The surface of a deformable body', () => {
  it('is that of the shape at rest', () => {
    const spheres = bound(ball(0.2, 0.05, [0.1, 0, 0]), 0.05, kBall);
    for (let i = 0; i < spheres.rest.length; i += 3) {
      const [x, y, z] = spheres.rest.slice(i, i + 3);
      expect(Math.hypot(x! - 0.1, y!, z!)).toBeCloseTo(0.2, 6);
    }
    const box = bound(block([8, 4, 6], 0.05, [1, 2, 3]), 0.05, kBox);
    const extent = new Box3().setFromArray(box.rest as unknown as number[]);
    extent.min.toArray().forEach((x, q) => expect(x).toBeCloseTo([0.8, 1.9, 2.85][q]!, 5));
    extent.max.toArray().forEach((x, q) => expect(x).toBeCloseTo([1.2, 2.1, 3.15][q]!, 5));
    const { triangles } = box.mesh;
    const volume = volumeOf({ vertices: box.rest, triangles });
    expect(volume / 0.024).toBeGreaterThan(0.97);
    expect(volume / 0.024).toBeLessThan(1);
  });

  it('turns and stretches with its particles', () => {
    const places = block([4, 3, 5], 0.1);
    const surface = bound(places, 0.1, { type: 'box', size: [0.4, 0.3, 0.5] });
    const map = new Matrix4()
      .makeRotationAxis(new Vector3(1, 2, 3).normalize(), 1.1)
      .multiply(new Matrix4().makeScale(1.4, 0.8, 1))
      .setPosition(5, 6, 7);
    const moved = (from: ArrayLike<number>): number[] =>
      Array.from({ length: from.length / 3 }, (_, i) =>
        new Vector3()
          .fromArray(from as number[], 3 * i)
          .applyMatrix4(map)
          .toArray(),
      ).flat();
    const to = new Float32Array(surface.rest.length);
    surface.follow(moved(places), 0.1, to);
    moved(surface.rest).forEach((x, i) => expect(to[i]).toBeCloseTo(x, 4));
  });

  it('keeps the thickness of a sheet that turns', () => {
    const places = block([6, 6, 1], 0.1);
    const surface = bound(places, 0.1, { type: 'box', size: [0.6, 0.6, 0.1] });
    const upright = places.map(
      (_, i) => [places[i - (i % 3)]!, 0, places[i - (i % 3) + 1]!][i % 3]!,
    );
    const to = new Float32Array(surface.rest.length);
    surface.follow(upright, 0.1, to);
    const size = new Box3().setFromArray(to as unknown as number[]).getSize(new Vector3());
    expect(size.x).toBeCloseTo(0.6, 5);
    expect(size.y).toBeCloseTo(0.1, 5);
    expect(size.z).toBeCloseTo(0.6, 5);
  });

  it('tears into closed parts, and is whole again if the time decreases', () => {
    const places = block([6, 3, 3], 0.1);
    const shape: SceneShape = { type: 'box', size: [0.6, 0.3, 0.3] };
    const lattice = new Lattice(places, 0.1);
    const apart = places.map((x, i) => (i % 3 === 0 && x > 0 ? x + 0.5 : x));
    expect(lattice.tear(places, 0.15)).toBe(false);
    expect(lattice.tear(apart, 0.15)).toBe(true);
    expect(lattice.tear(places, 0.15)).toBe(false); // tears are permanent
    const torn = new BoundSurface(lattice, places, shape);
    const vertices = new Float32Array(torn.rest.length);
    torn.follow(apart, 0.1, vertices);
    const { triangles } = torn.mesh;
    expect(openEdges({ triangles })).toBe(0);
    for (let i = 0; i < vertices.length; i += 3) {
      const inGap = vertices[i]! > 0.01 && vertices[i]! < 0.49;
      expect(inGap).toBe(false); // no surface spans the gap
    }
    expect(volumeOf({ vertices, triangles }) / 0.054).toBeGreaterThan(0.9);
    expect(lattice.mend()).toBe(true);
    expect(lattice.mend()).toBe(false);
    const whole = new BoundSurface(lattice, places, shape);
    expect(whole.mesh.count).toBeLessThan(torn.mesh.count);
  });

  it('has normals that point outward', () => {
    const surface = bound(ball(0.2, 0.05, [0, 0, 0]), 0.05, { type: 'sphere', radius: 0.2 });
    const normals = new Float32Array(surface.rest.length);
    writeNormals(surface.rest, surface.mesh.triangles, normals);
    for (let i = 0; i < normals.length; i += 3) {
      const along =
        (normals[i]! * surface.rest[i]! +
          normals[i + 1]! * surface.rest[i + 1]! +
          normals[i + 2]! * surface.rest[i + 2]!) /
        0.2;
      expect(along).toBeGreaterThan(0.97);
    }
  });
});
