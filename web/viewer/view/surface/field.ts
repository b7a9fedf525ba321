/** Distances to a surface at the nodes of a grid; negative inside. */
export interface Field {
  /** Nodes along x, y and z; x runs fastest. */
  size: [number, number, number];
  origin: [number, number, number];
  step: number;
  distances: Float32Array;
  /** Means of the particles' values near each node, in the same order. */
  values: Float32Array | undefined;
}

/** Range of a particle / particle radius. */
const kReach = 4;

/** Node spacing / particle radius, if memory permits. */
const kStep = 1;
const kMostNodes = 1_500_000;

/**
 * Returns the surface field of particles after Y. Zhu and R. Bridson, "Animating sand as a fluid"
 * (2005): at each node, the distance to the weighted mean of nearby particles minus `size` times
 * their radius.
 */
export function fieldAround(
  places: ArrayLike<number>,
  radius: number,
  values?: ArrayLike<number>,
  size = 1,
): Field {
  const reach = kReach * radius;
  const grid = gridAround(places, radius, reach);
  const nodes = grid.size[0] * grid.size[1] * grid.size[2];
  const sums = new Float32Array(4 * nodes);
  const valueSums = values && new Float32Array(nodes);
  for (let i = 0; 3 * i < places.length; ++i) {
    spread(grid, sums, valueSums, reach, places, i, values?.[i] ?? 0);
  }
  const distances = new Float32Array(nodes).fill(reach);
  const { origin, step } = grid;
  const [nx, ny, nz] = grid.size;
  for (let n = 0, z = 0; z < nz; ++z) {
    for (let y = 0; y < ny; ++y) {
      for (let x = 0; x < nx; ++x, ++n) {
        const weight = sums[4 * n + 3]!;
        if (weight <= 1e-6) continue;
        const dx = origin[0] + step * x - sums[4 * n]! / weight;
        const dy = origin[1] + step * y - sums[4 * n + 1]! / weight;
        const dz = origin[2] + step * z - sums[4 * n + 2]! / weight;
        distances[n] = Math.sqrt(dx * dx + dy * dy + dz * dz) - size * radius;
        if (valueSums) valueSums[n]! /= weight;
      }
    }
  }
  return { ...grid, distances, values: valueSums };
}

type Grid = Pick<Field, 'size' | 'origin' | 'step'>;

/** Returns nodes at multiples of the spacing, so that they remain fixed while particles move. */
function gridAround(places: ArrayLike<number>, radius: number, reach: number): Grid {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < places.length; ++i) {
    low[i % 3] = Math.min(low[i % 3]!, places[i]!);
    high[i % 3] = Math.max(high[i % 3]!, places[i]!);
  }
  const volume = low.reduce((all, least, q) => all * (high[q]! - least + 2 * reach), 1);
  const step = Math.max(kStep * radius, Math.cbrt(volume / kMostNodes));
  const first = low.map((least) => Math.floor((least - reach) / step));
  const last = high.map((most) => Math.ceil((most + reach) / step));
  const size = first.map((begin, q) => last[q]! - begin + 1);
  const origin = first.map((begin) => step * begin);
  return { size: size as Field['size'], origin: origin as Field['origin'], step };
}

function spread(
  { size, origin, step }: Grid,
  sums: Float32Array,
  valueSums: Float32Array | undefined,
  reach: number,
  places: ArrayLike<number>,
  particle: number,
  value: number,
): void {
  const px = places[3 * particle]!;
  const py = places[3 * particle + 1]!;
  const pz = places[3 * particle + 2]!;
  const from = (p: number, q: number): number => Math.ceil((p - reach - origin[q]!) / step);
  const to = (p: number, q: number): number => Math.floor((p + reach - origin[q]!) / step);
  const [x0, x1] = [from(px, 0), to(px, 0)];
  const [y0, y1] = [from(py, 1), to(py, 1)];
  const [z0, z1] = [from(pz, 2), to(pz, 2)];
  for (let z = z0; z <= z1; ++z) {
    const dz = origin[2] + step * z - pz;
    for (let y = y0; y <= y1; ++y) {
      const dy = origin[1] + step * y - py;
      let n = (z * size[1] + y) * size[0] + x0;
      for (let x = x0; x <= x1; ++x, ++n) {
        const dx = origin[0] + step * x - px;
        const near = 1 - (dx * dx + dy * dy + dz * dz) / (reach * reach);
        if (near <= 0) continue;
        const weight = near * near * near;
        sums[4 * n]! += weight * px;
        sums[4 * n + 1]! += weight * py;
        sums[4 * n + 2]! += weight * pz;
        sums[4 * n + 3]! += weight;
        if (valueSums) valueSums[n]! += weight * value;
      }
    }
  }
}
