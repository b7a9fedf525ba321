/**
 * The triangles of marching cubes (W. Lorensen and H. Cline, 1987), derived from the faces of the
 * cube. The published table has holes at ambiguous faces. Here, two diagonally opposite inside
 * corners of a face are separated by both adjacent cubes, so that the surface is closed.
 */

/** Corner c of the cube is at (bit 0, bit 1, bit 2) of c. */
const kCorners = 8;

/** Edges along x, y and z as pairs of corners, the lower one first. */
export const kEdges: readonly (readonly [number, number])[] = [1, 2, 4].flatMap((axis) =>
  Array.from({ length: kCorners }, (_, corner) => corner)
    .filter((corner) => (corner & axis) === 0)
    .map((corner) => [corner, corner | axis] as const),
);

/** Corners of the six faces, anticlockwise as seen from outside. */
const kFaces: readonly (readonly number[])[] = [
  [0, 4, 6, 2],
  [1, 3, 7, 5],
  [0, 1, 5, 4],
  [2, 6, 7, 3],
  [0, 2, 3, 1],
  [4, 5, 7, 6],
];

function edgeBetween(a: number, b: number): number {
  const [low, high] = a < b ? [a, b] : [b, a];
  return kEdges.findIndex(([first, second]) => first === low && second === high);
}

/** Links, on one face, the edge after a run of inside corners to the edge before it. */
function linkFace(face: readonly number[], inside: number, next: Map<number, number>): void {
  const isInside = (i: number): boolean => ((inside >> face[i & 3]!) & 1) === 1;
  for (let begin = 0; begin < 4; ++begin) {
    if (!isInside(begin) || isInside(begin + 3)) continue;
    let end = begin;
    while (isInside(end + 1)) ++end;
    const entered = edgeBetween(face[(begin + 3) & 3]!, face[begin]!);
    next.set(edgeBetween(face[end & 3]!, face[(end + 1) & 3]!), entered);
  }
}

/** Returns the edges of the triangles' corners, three per triangle, for a set of inside corners. */
function trianglesOf(inside: number): number[] {
  const next = new Map<number, number>();
  for (const face of kFaces) linkFace(face, inside, next);
  const triangles: number[] = [];
  while (next.size > 0) {
    const loop: number[] = [];
    let [edge] = next.keys();
    while (edge !== undefined && next.has(edge)) {
      const following: number | undefined = next.get(edge);
      loop.push(edge);
      next.delete(edge);
      edge = following;
    }
    for (let i = 2; i < loop.length; ++i) triangles.push(loop[0]!, loop[i]!, loop[i - 1]!);
  }
  return triangles;
}

/** The triangles, indexed by the inside corners, one bit each. */
export const kTriangles: readonly (readonly number[])[] = Array.from({ length: 256 }, (_, inside) =>
  trianglesOf(inside),
);
