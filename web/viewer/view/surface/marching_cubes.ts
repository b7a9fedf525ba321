import { kEdges, kTriangles } from './cube_cases';
import type { Field } from './field';

/** Triangles with shared corners; normals point outwards. */
export interface Surface {
  positions: Float32Array<ArrayBuffer>;
  normals: Float32Array<ArrayBuffer>;
  values: Float32Array<ArrayBuffer> | undefined;
  indices: Uint32Array<ArrayBuffer>;
}

/** Returns the surface with distance 0. */
export function marchingCubes(field: Field): Surface {
  const { size, distances } = field;
  const [nx, ny, nz] = size;
  const strides = [1, nx, nx * ny];
  const corners = Array.from({ length: 8 }, (_, c) =>
    [0, 1, 2].reduce((offset, q) => offset + ((c >> q) & 1) * strides[q]!, 0),
  );
  const mesh = new MeshBuilder(field);
  for (let z = 0; z + 1 < nz; ++z) {
    for (let y = 0; y + 1 < ny; ++y) {
      let node = (z * ny + y) * nx;
      for (let x = 0; x + 1 < nx; ++x, ++node) {
        let inside = 0;
        for (let c = 0; c < 8; ++c) if (distances[node + corners[c]!]! < 0) inside |= 1 << c;
        if (inside === 0 || inside === 255) continue;
        for (const edge of kTriangles[inside]!) {
          const [low, high] = kEdges[edge]!;
          mesh.addCorner(node + corners[low]!, node + corners[high]!);
        }
      }
    }
  }
  return mesh.finish();
}

class MeshBuilder {
  private readonly positions: number[] = [];
  private readonly values: number[] = [];
  private readonly indices: number[] = [];
  /** The vertex on the edge from a node along each axis; -1: none yet. */
  private readonly vertices: Int32Array;

  constructor(private readonly field: Field) {
    this.vertices = new Int32Array(3 * field.distances.length).fill(-1);
  }

  /** Adds a triangle corner on the edge between two nodes, the lower one first. */
  addCorner(low: number, high: number): void {
    const [nx, ny] = this.field.size;
    const axis = high - low === 1 ? 0 : high - low === nx ? 1 : 2;
    const key = 3 * low + axis;
    let vertex = this.vertices[key]!;
    if (vertex < 0) {
      vertex = this.vertices[key] = this.positions.length / 3;
      this.addVertex(low, high, axis, [
        low % nx,
        Math.floor(low / nx) % ny,
        Math.floor(low / (nx * ny)),
      ]);
    }
    this.indices.push(vertex);
  }

  finish(): Surface {
    const positions = Float32Array.from(this.positions);
    const indices = Uint32Array.from(this.indices);
    const values = this.field.values && Float32Array.from(this.values);
    return { positions, normals: normalsOf(positions, indices), values, indices };
  }

  private addVertex(low: number, high: number, axis: number, node: number[]): void {
    const { distances, values, origin, step } = this.field;
    const [a, b] = [distances[low]!, distances[high]!];
    const share = a / (a - b);
    for (let q = 0; q < 3; ++q) {
      this.positions.push(origin[q]! + step * (node[q]! + (q === axis ? share : 0)));
    }
    if (values) this.values.push(values[low]! + share * (values[high]! - values[low]!));
  }
}

/** Returns area-weighted means of the adjacent triangles' normals at each vertex. */
function normalsOf(positions: Float32Array, indices: Uint32Array): Float32Array<ArrayBuffer> {
  const normals = new Float32Array(positions.length);
  for (let t = 0; t < indices.length; t += 3) {
    const [a, b, c] = [3 * indices[t]!, 3 * indices[t + 1]!, 3 * indices[t + 2]!];
    const side = (from: number, to: number, q: number): number =>
      positions[to + q]! - positions[from + q]!;
    const [ux, uy, uz] = [side(a, b, 0), side(a, b, 1), side(a, b, 2)];
    const [vx, vy, vz] = [side(a, c, 0), side(a, c, 1), side(a, c, 2)];
    const [nx, ny, nz] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    for (const corner of [a, b, c]) {
      normals[corner]! += nx;
      normals[corner + 1]! += ny;
      normals[corner + 2]! += nz;
    }
  }
  for (let i = 0; i < normals.length; i += 3) {
    const length = Math.hypot(normals[i]!, normals[i + 1]!, normals[i + 2]!) || 1;
    for (let q = 0; q < 3; ++q) normals[i + q]! /= length;
  }
  return normals;
}
