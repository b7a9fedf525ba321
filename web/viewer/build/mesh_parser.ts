import { BufferAttribute, BufferGeometry, Mesh } from 'three';
import { OBJLoader } from 'three/examples/jsm/loaders/OBJLoader.js';
import { STLLoader } from 'three/examples/jsm/loaders/STLLoader.js';
import { mergeVertices } from 'three/examples/jsm/utils/BufferGeometryUtils.js';
import type { Vector } from '../../client/index';

/**
 * Returns the corners of all triangles of an .obj file or, if `isStl`, of an .stl file. Returns none
 * if the file is incomplete. References to absent vertices give NaN.
 */
export function parseCorners(bytes: ArrayBuffer, isStl: boolean): Vector[] {
  try {
    return isStl ? cornersOf(new STLLoader().parse(bytes)) : cornersOfObj(bytes);
  } catch (error) {
    if (error instanceof RangeError) return [];
    throw error;
  }
}

function cornersOfObj(bytes: ArrayBuffer): Vector[] {
  const parts: Vector[][] = [];
  new OBJLoader().parse(new TextDecoder().decode(bytes)).traverse((part) => {
    if (part instanceof Mesh) parts.push(cornersOf((part as Mesh).geometry));
  });
  return parts.flat();
}

function cornersOf(geometry: BufferGeometry): Vector[] {
  const places = geometry.getAttribute('position');
  return Array.from({ length: places.count }, (_, n) => [
    places.getX(n),
    places.getY(n),
    places.getZ(n),
  ]);
}

/** Merges corners within `tolerance` to one vertex. */
export function mergeCorners(
  corners: readonly Vector[],
  tolerance: number,
): { vertices: Vector[]; triangles: [number, number, number][] } {
  const soup = new BufferGeometry();
  soup.setAttribute('position', new BufferAttribute(new Float32Array(corners.flat()), 3));
  const merged = mergeVertices(soup, tolerance);
  const numbers = Array.from(merged.getIndex()!.array);
  return {
    vertices: cornersOf(merged),
    triangles: Array.from({ length: numbers.length / 3 }, (_, n) => [
      numbers[3 * n]!,
      numbers[3 * n + 1]!,
      numbers[3 * n + 2]!,
    ]),
  };
}
