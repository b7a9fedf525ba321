import type { Vector } from '../../client/index';
import { meshVolume } from './measures';

/** A closed surface about the origin, whose longest side is 1. */
export interface MeshShape {
  name: string;
  vertices: Vector[];
  triangles: [number, number, number][];
  /** Over that of its cube. */
  volume: number;
}

/** What a message may hold: `message_values` of the protocol, with room for the rest of a body. */
const kMostValues = 95_000;
/** Of the longest side: corners as near are the same. Files have seven digits at most. */
const kTolerance = 1e-6;

/** A mesh of an .obj or .stl file; or in words why it is none. */
export async function readMesh(file: File): Promise<MeshShape | { fault: string }> {
  const { name } = file;
  const { mergeCorners, parseCorners } = await import('./mesh_parser'); // few need it
  const corners = parseCorners(await file.arrayBuffer(), /\.stl$/i.test(name));
  if (corners.length < 3 || !corners.flat().every(Number.isFinite)) {
    return { fault: `“${name}” contains no triangles. The file must be .obj or .stl.` };
  }
  const fitted = fit(corners);
  if (!fitted) return { fault: `“${name}” is a single point.` };
  const { vertices, triangles } = mergeCorners(fitted, kTolerance);
  if (4 * (vertices.length + triangles.length) > kMostValues) {
    const most = Math.floor(kMostValues / 6); // closed surfaces have half as many vertices
    return { fault: `“${name}” has too many triangles. About ${most} are possible.` };
  }
  return { name: name.slice(0, 64), vertices, triangles, volume: meshVolume(vertices, triangles) };
}

/** About the origin, with a longest side of 1; undefined: it has no size. */
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
