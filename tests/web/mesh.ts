/** A closed mesh: three coordinates per vertex, three indices per triangle. */
export interface Mesh {
  vertices: ArrayLike<number>;
  triangles: ArrayLike<number>;
}

/** Returns the volume inside a closed mesh; negative if its triangles are clockwise from outside. */
export function volumeOf({ vertices: p, triangles }: Mesh): number {
  let six = 0;
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [3 * triangles[t]!, 3 * triangles[t + 1]!, 3 * triangles[t + 2]!];
    six += p[a]! * (p[b + 1]! * p[c + 2]! - p[b + 2]! * p[c + 1]!);
    six += p[a + 1]! * (p[b + 2]! * p[c]! - p[b]! * p[c + 2]!);
    six += p[a + 2]! * (p[b]! * p[c + 1]! - p[b + 1]! * p[c]!);
  }
  return six / 6;
}

/** Returns the number of edges without an opposite edge of another triangle. */
export function openEdges({ triangles }: Pick<Mesh, 'triangles'>): number {
  const edges = new Map<string, number>();
  for (let i = 0; i < triangles.length; ++i) {
    const from = triangles[i]!;
    const to = triangles[i % 3 === 2 ? i - 2 : i + 1]!;
    const key = [Math.min(from, to), Math.max(from, to)].join(' ');
    edges.set(key, (edges.get(key) ?? 0) + (from < to ? 1 : -1));
  }
  return [...edges.values()].filter((sum) => sum !== 0).length;
}
