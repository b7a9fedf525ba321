/**
 * The triangles of marching cubes (W. Lorensen and H. Cline, 1987), made from what each face of the
 * cube shows, instead of from a table: W. Lorensen's has holes where neighbours decide otherwise.
 * Where two corners of a face across from each other are inside, they are kept apart; both cubes at
 * the face do so, and the surface is closed.
 */

/** Corner c of the cube is at (bit 0, bit 1, bit 2) of c. */
const kCorners = 8;

/** Edges as their two corners, the lower one first: along x, y and z. */
export const kEdges: readonly (readonly [number, number])[] = [1, 2, 4].flatMap((axis) =>
  Array.from({ length: kCorners }, (_, corner) => corner)
    .filter((corner) => (corner & axis) === 0)
    .map((corner) => [corner, corner | axis] as const),
);

/** Corners of the six faces, in turn to the left as seen from outside. */
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

/** On one face: from the edge by which a run of inside corners is left to that by which it began. */
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

/** The edges that the corners of triangles are on, three by three, for the corners inside. */
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

/** By the corners inside, one bit each. */
export const kTriangles: readonly (readonly number[])[] = Array.from({ length: 256 }, (_, inside) =>
  trianglesOf(inside),
);
