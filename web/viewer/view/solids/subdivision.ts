/** A mesh of quads that a linear map makes from the corners of a coarser one. */
export interface Subdivided {
  count: number;
  /** Row `i` of the map is [begin[i], begin[i + 1]) of `sources` and `weights`. */
  begin: Uint32Array;
  sources: Uint32Array;
  weights: Float32Array;
  /** Six indices for each quad, as two triangles. */
  triangles: Uint32Array;
  /** A coarse quad at each vertex. */
  quadOf: Uint32Array;
  /** All coarse quads at each vertex satisfy the condition. */
  isOuter: Uint8Array;
}

type Row = Map<number, number>;

interface Edge {
  index: number;
  ends: [number, number];
  quads: number[];
}

function add(to: Row, corner: number, weight: number): void {
  to.set(corner, (to.get(corner) ?? 0) + weight);
}

function addRow(to: Row, row: Row, factor: number): void {
  for (const [corner, weight] of row) add(to, corner, factor * weight);
}

/**
 * Returns one step of the subdivision of E. Catmull and J. Clark (1978). Edges of more than two
 * quads, where parts of the body only touch, stay where they are.
 */
export function subdivide(corners: number, quads: number[], isOuter: boolean[]): Subdivided {
  const rows: Row[] = [];
  const quadOf: number[] = [];
  const outer: boolean[] = [];
  const put = (row: Row, around: readonly number[]): number => {
    quadOf.push(around[0]!);
    outer.push(around.every((quad) => isOuter[quad]));
    return rows.push(row) - 1;
  };
  const count = quads.length / 4;
  const cornersOf = (quad: number): number[] => quads.slice(4 * quad, 4 * quad + 4);
  const faces = Array.from({ length: count }, (_, quad) => {
    const row: Row = new Map();
    for (const corner of cornersOf(quad)) add(row, corner, 0.25);
    return put(row, [quad]);
  });
  const { edges, around } = connect(corners, quads);
  for (const edge of edges.values()) edge.index = put(edgeRow(edge, faces, rows), edge.quads);
  const moved = around.map((touching, corner) => {
    if (touching.quads.length === 0) return -1;
    return put(cornerRow(corner, touching, faces, rows), touching.quads);
  });
  const triangles: number[] = [];
  for (let quad = 0; quad < count; ++quad) {
    const all = cornersOf(quad);
    for (let i = 0; i < 4; ++i) {
      const [last, here, next] = [all[(i + 3) % 4]!, all[i]!, all[(i + 1) % 4]!];
      const ahead = edges.get(keyOf(here, next))!.index;
      const back = edges.get(keyOf(last, here))!.index;
      triangles.push(moved[here]!, ahead, faces[quad]!, moved[here]!, faces[quad]!, back);
    }
  }
  return packed(rows, triangles, quadOf, outer);
}

const keyOf = (a: number, b: number): number => Math.min(a, b) * 2 ** 26 + Math.max(a, b);

interface Touching {
  quads: number[];
  edges: Edge[];
}

/** Returns the edges, and the quads and edges at each corner. */
function connect(
  corners: number,
  quads: number[],
): { edges: Map<number, Edge>; around: Touching[] } {
  const edges = new Map<number, Edge>();
  const around = Array.from({ length: corners }, (): Touching => ({ quads: [], edges: [] }));
  quads.forEach((from, i) => {
    const quad = i >> 2;
    const to = quads[4 * quad + ((i + 1) % 4)]!;
    around[from]!.quads.push(quad);
    let edge = edges.get(keyOf(from, to));
    if (!edge) {
      edge = { index: 0, ends: [from, to], quads: [] };
      edges.set(keyOf(from, to), edge);
      around[from]!.edges.push(edge);
      around[to]!.edges.push(edge);
    }
    edge.quads.push(quad);
  });
  return { edges, around };
}

function edgeRow({ ends, quads }: Edge, faces: number[], rows: Row[]): Row {
  const row: Row = new Map();
  const isSmooth = quads.length === 2;
  for (const end of ends) add(row, end, isSmooth ? 0.25 : 0.5);
  if (isSmooth) for (const quad of quads) addRow(row, rows[faces[quad]!]!, 0.25);
  return row;
}

function cornerRow(corner: number, { quads, edges }: Touching, faces: number[], rows: Row[]): Row {
  const row: Row = new Map();
  const sharp = edges.filter((edge) => edge.quads.length !== 2);
  if (sharp.length > 0) {
    add(row, corner, 1);
    return row;
  }
  const n = quads.length;
  for (const quad of quads) addRow(row, rows[faces[quad]!]!, 1 / (n * n));
  for (const { ends } of edges) for (const end of ends) add(row, end, 1 / (n * n));
  add(row, corner, (n - 3) / n);
  return row;
}

function packed(rows: Row[], triangles: number[], quadOf: number[], outer: boolean[]): Subdivided {
  const begin = new Uint32Array(rows.length + 1);
  rows.forEach((row, i) => (begin[i + 1] = begin[i]! + row.size));
  const sources = new Uint32Array(begin[rows.length]!);
  const weights = new Float32Array(sources.length);
  let at = 0;
  for (const row of rows) {
    for (const [source, weight] of row) {
      sources[at] = source;
      weights[at++] = weight;
    }
  }
  return {
    count: rows.length,
    begin,
    sources,
    weights,
    triangles: Uint32Array.from(triangles),
    quadOf: Uint32Array.from(quadOf),
    isOuter: Uint8Array.from(outer, Number),
  };
}
