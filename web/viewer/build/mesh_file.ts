import type { Vector } from '../../client/index';
import { meshVolume } from './measures';

/** A closed surface centred at the origin, with a longest side of 1. */
export interface MeshShape {
  name: string;
  vertices: Vector[];
  triangles: [number, number, number][];
  /** Volume divided by the volume of its cube. */
  volume: number;
}

/** The limit `message_values` of the protocol, minus the other members of a body. */
const kMostValues = 95_000;
/** Corners closer than this share of the longest side are merged. Files have at most 7 digits. */
const kTolerance = 1e-6;

/** Reads a mesh from an .obj or .stl file. Returns the reason if it is invalid. */
export async function readMesh(file: File): Promise<MeshShape | { fault: string }> {
  const { name } = file;
  const { mergeCorners, parseCorners } = await import('./mesh_parser'); // loaded on demand
  const corners = parseCorners(await file.arrayBuffer(), /\.stl$/i.test(name));
  if (corners.length < 3 || !corners.flat().every(Number.isFinite)) {
    return { fault: `“${name}” contains no triangles. The file must be .obj or .stl.` };
  }
  const fitted = fit(corners);
  if (!fitted) return { fault: `“${name}” is a single point.` };
  const { vertices, triangles } = mergeCorners(fitted, kTolerance);
  if (4 * (vertices.length + triangles.length) > kMostValues) {
    const most = Math.floor(kMostValues / 6); // a closed surface has half as many vertices as triangles
    return { fault: `“${name}” has too many triangles. About ${most} are possible.` };
  }
  return { name: name.slice(0, 64), vertices, triangles, volume: meshVolume(vertices, triangles) };
}

/** Centres and scales the mesh to a longest side of 1; undefined if its size is 0. */
function fit(places: readonly Vector[]): Vector[] | undefined {
  const [least, most]: [Vector, Vector] = [
    [Infinity, Infinity, Infinity],
    [-Infinity, -Infinity, -Infinity],
  ];
  for (const place of places) {
    place.forEach((x, axis) => {
      least[axis] = Math.min(least[axis]!, x);
      most[axis] = Math.max(most[axis]!, x);
    });
  }
  const longest = Math.max(...most.map((x, axis) => x - least[axis]!));
  if (!(longest > 0)) return undefined;
  return places.map(
    (place) => place.map((x, axis) => (x - (least[axis]! + most[axis]!) / 2) / longest) as Vector,
  );
}
