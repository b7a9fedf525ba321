import { Box3, Vector3 } from 'three';
import type { SceneShape } from '../../../client/index';
import { hullOf } from './cell_hull';
import type { CellHull } from './cell_hull';
import type { Lattice } from './lattice';
import { measureFrames } from './lattice_frames';
import { projectionTo } from './rest_surface';
import { subdivide } from './subdivision';
import type { Subdivided } from './subdivision';

/** Vertices do not move farther than this to the surface of the shape, in spacings. */
const kReach = 1.5;

/**
 * A smooth surface around the cells of a lattice. At rest, it is the surface of the body's shape.
 * It follows the particles: each vertex moves with the cells around it.
 */
export class BoundSurface {
  readonly mesh: Subdivided;
  /** The vertices at rest, in the axes of the shape. */
  readonly rest: Float32Array;
  private readonly hull: CellHull;
  private readonly corners: Float32Array;
  private readonly frames: Float32Array;
  /** The way of each vertex to the surface of the shape, in the frame of its particle. */
  private readonly shifts: Float32Array;

  constructor(
    private readonly lattice: Lattice,
    restPlaces: ArrayLike<number>,
    shape: SceneShape,
  ) {
    this.hull = hullOf(lattice);
    const { corners, quads, isOuter } = this.hull;
    this.mesh = subdivide(corners.length, quads, isOuter);
    this.corners = new Float32Array(3 * corners.length);
    this.frames = new Float32Array(9 * lattice.count);
    this.shifts = new Float32Array(3 * this.mesh.count);
    this.rest = new Float32Array(3 * this.mesh.count);
    this.follow(restPlaces, lattice.spacing, this.rest);
    this.fit(restPlaces, shape);
  }

  /** Writes the vertices for these positions. `unit` is the spacing in their units. */
  follow(places: ArrayLike<number>, unit: number, to: Float32Array): void {
    const { lattice, mesh, frames, corners, shifts } = this;
    measureFrames(lattice, places, unit, frames);
    this.placeCorners(places);
    const { begin, sources, weights, count } = mesh;
    for (let vertex = 0; vertex < count; ++vertex) {
      let [x, y, z] = [0, 0, 0];
      for (let i = begin[vertex]!; i < begin[vertex + 1]!; ++i) {
        const weight = weights[i]!;
        const corner = 3 * sources[i]!;
        x += weight * corners[corner]!;
        y += weight * corners[corner + 1]!;
        z += weight * corners[corner + 2]!;
      }
      const at = 3 * vertex;
      const frame = 9 * this.particleOf(vertex);
      for (let q = 0; q < 3; ++q) {
        const shift = shifts[at + q]!;
        x += shift * frames[frame + 3 * q]!;
        y += shift * frames[frame + 3 * q + 1]!;
        z += shift * frames[frame + 3 * q + 2]!;
      }
      to[at] = x;
      to[at + 1] = y;
      to[at + 2] = z;
    }
  }

  /** Returns a particle at a vertex. */
  particleOf(vertex: number): number {
    return this.hull.particles[this.mesh.quadOf[vertex]!]!;
  }

  private placeCorners(places: ArrayLike<number>): void {
    const { corners, frames } = this;
    this.hull.corners.forEach((cells, corner) => {
      let [x, y, z] = [0, 0, 0];
      for (const { particle, bits } of cells) {
        x += places[3 * particle]!;
        y += places[3 * particle + 1]!;
        z += places[3 * particle + 2]!;
        for (let q = 0; q < 3; ++q) {
          const half = (bits >> q) & 1 ? 0.5 : -0.5;
          const column = 9 * particle + 3 * q;
          x += half * frames[column]!;
          y += half * frames[column + 1]!;
          z += half * frames[column + 2]!;
        }
      }
      corners[3 * corner] = x / cells.length;
      corners[3 * corner + 1] = y / cells.length;
      corners[3 * corner + 2] = z / cells.length;
    });
  }

  /** Moves the vertices at rest to the surface of the shape, except those on the sides of tears. */
  private fit(restPlaces: ArrayLike<number>, shape: SceneShape): void {
    const { spacing, count } = this.lattice;
    const hull = new Box3();
    const point = new Vector3();
    for (let i = 0; i < count; ++i) {
      hull.expandByPoint(
        point.set(restPlaces[3 * i]!, restPlaces[3 * i + 1]!, restPlaces[3 * i + 2]!),
      );
    }
    hull.expandByScalar(spacing / 2);
    const project = projectionTo(shape, hull, spacing);
    if (!project) return;
    const before = new Vector3();
    for (let vertex = 0; vertex < this.mesh.count; ++vertex) {
      if (this.mesh.isOuter[vertex] === 0) continue;
      project(point.copy(before.fromArray(this.rest, 3 * vertex)));
      if (point.distanceTo(before) > kReach * spacing) continue;
      // The frames at rest are the axes of the shape, one spacing long.
      point.toArray(this.rest, 3 * vertex);
      point
        .sub(before)
        .divideScalar(spacing)
        .toArray(this.shifts, 3 * vertex);
    }
  }
}

/** Writes unit normals: the mean of the triangles at each vertex, weighted by area. */
export function writeNormals(
  vertices: Float32Array,
  triangles: Uint32Array,
  normals: Float32Array,
): void {
  normals.fill(0);
  for (let i = 0; i < triangles.length; i += 3) {
    const [a, b, c] = [3 * triangles[i]!, 3 * triangles[i + 1]!, 3 * triangles[i + 2]!];
    const abx = vertices[b]! - vertices[a]!;
    const aby = vertices[b + 1]! - vertices[a + 1]!;
    const abz = vertices[b + 2]! - vertices[a + 2]!;
    const acx = vertices[c]! - vertices[a]!;
    const acy = vertices[c + 1]! - vertices[a + 1]!;
    const acz = vertices[c + 2]! - vertices[a + 2]!;
    const x = aby * acz - abz * acy;
    const y = abz * acx - abx * acz;
    const z = abx * acy - aby * acx;
    for (const corner of [a, b, c]) {
      normals[corner]! += x;
      normals[corner + 1]! += y;
      normals[corner + 2]! += z;
    }
  }
  for (let i = 0; i < normals.length; i += 3) {
    const length = Math.hypot(normals[i]!, normals[i + 1]!, normals[i + 2]!) || 1;
    normals[i]! /= length;
    normals[i + 1]! /= length;
    normals[i + 2]! /= length;
  }
}
