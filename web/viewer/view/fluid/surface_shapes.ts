import { NeighbourGrid } from './neighbour_grid';
import type { WallBox } from './neighbour_grid';
import type { NeighbourPlaces } from './solid_neighbours';

/** Radius of the neighbourhood [particle radii]. */
export const kReach = 4.5;
/** The sum of the weights within a liquid, and the variance along an axis [squared reaches]. */
const kWithin = (0.07619 * 4 * Math.PI * kReach ** 3) / 8;
const kVariance = 1 / 9;

/** Neighbourhoods with more than this share of the particles of a full one have no surface. */
const kFull = 0.8;
/** Limits of the weight within the reach, relative to that within a liquid, at the surface. */
const kSurface = [0.78, 0.95] as const;

/** More particles are drawn as spheres, because their shapes would take most of a picture's time. */
export const kMostShaped = 40_000;

/** Semi-axes of an ellipsoid within the liquid, and their reduction without neighbours [radii]. */
export const kSphere = 1.4;
const kFlat = 0.75;
/** 1 / (1 - the variance along the normal of a flat surface): full displacement along the normal. */
const kFollow = 1.5;

/**
 * The share of solids in the neighbourhood from which on a particle begins to extend to the solid,
 * and that with the full extension; the extension [particle radii].
 */
const kTouch = [0.03, 0.15] as const;
const kExtension = 0.6;

/** Greatest displacement along an axis [particle radii]. */
export const kMostShift = 2;
/** Greatest entry of a shape [particle radii]. */
export const kMostShape = 4;

/** Numbers for each particle: two entries of the shape in each of three, and the displacement. */
export const kShapeNumbers = 4;

/**
 * Shapes and displacements that make particles at the surface of a liquid an even surface: ellipsoids
 * that are flat along the directions with few neighbours, at the mean height of the surface's
 * particles around them. A simple form of the method of J. Yu and G. Turk, "Reconstructing surfaces of
 * particle-based fluids using anisotropic kernels" (2013): shapes are linear in the variances of the
 * neighbours, which needs no eigenvectors, and only the surface's particles are averaged, so that the
 * liquid does not shrink. Walls mirror the particles beside them. Solids continue the liquid, and the
 * particles beside them extend to their surfaces.
 */
export class SurfaceShapes {
  private readonly ranges = new Uint32Array(18);
  /**
   * Sums of the weights, of the weighted distances, and of their products: xx, yy, zz, xy, xz, yz;
   * then sums of the weights and weighted distances of solids.
   */
  private readonly moments = new Float64Array(14);
  /** The neighbours of the candidates: three distances, and the weight. */
  private near = new Float32Array(4096);
  private nearIndex = new Uint32Array(1024);
  private nears = 0;

  /**
   * Writes the shapes of `count` particles of this radius [quanta]; see pack(). The coordinates of
   * solids follow theirs in `places`.
   */
  write(
    places: ArrayLike<number>,
    count: number,
    solids: NeighbourPlaces['weights'],
    radius: number,
    walls: WallBox,
    to: Uint32Array,
  ): void {
    const all = count + solids.length;
    const grid = new NeighbourGrid(places, all, kReach * radius);
    const candidates = this.candidatesOf(grid, count, radius, walls, to);
    const at = new Float32Array(all); // how much a particle belongs to the surface
    const starts = new Uint32Array(candidates.length + 1);
    const variances = new Float32Array(6 * candidates.length);
    const touches = new Float32Array(3 * candidates.length);
    const isCandidate = new Uint8Array(all);
    for (const i of candidates) isCandidate[i] = 1;
    this.nears = 0;
    const near = { places, count, solids, radius, walls, isCandidate };
    candidates.forEach((i, n) => {
      const weight = this.measure(grid, near, i, variances.subarray(6 * n, 6 * n + 6));
      touches.set(this.touch(), 3 * n);
      at[i] = 1 - smoothStep(kSurface, weight / kWithin);
      starts[n + 1] = this.nears;
    });
    candidates.forEach((i, n) => {
      const { shape, shift } = this.shape(at, starts, n, i, variances.subarray(6 * n, 6 * n + 6));
      extend(shape, shift, touches.subarray(3 * n, 3 * n + 3));
      to.set(pack(shape, shift), kShapeNumbers * i);
    });
  }

  /** Returns the particles that can be at the surface. Writes spheres for all others. */
  private candidatesOf(
    grid: NeighbourGrid,
    count: number,
    radius: number,
    walls: WallBox,
    to: Uint32Array,
  ): number[] {
    const candidates: number[] = [];
    const full = new Uint8Array(grid.cells); // 0: unknown, 1: false, 2: true
    const isTooMany = count > kMostShaped;
    const [first, second, third, none] = pack([kSphere, kSphere, kSphere, 0, 0, 0], [0, 0, 0]);
    for (let i = 0; i < count; ++i) {
      const cell = grid.cellOf[i]!;
      if (full[cell] === 0 && !isTooMany) {
        const room = grid.volumeAround(cell, walls) / (2 * radius) ** 3;
        full[cell] = grid.countAround(cell) > kFull * room ? 2 : 1;
      }
      if (full[cell] === 1) {
        candidates.push(i);
        continue;
      }
      to[kShapeNumbers * i] = first!;
      to[kShapeNumbers * i + 1] = second!;
      to[kShapeNumbers * i + 2] = third!;
      to[kShapeNumbers * i + 3] = none!;
    }
    return candidates;
  }

  /**
   * Writes the variances of a particle's neighbours, relative to those within a liquid: xx, yy, zz,
   * xy, xz, yz. Returns the sum of the weights. Adds the candidates among them to `near`.
   */
  private measure(
    grid: NeighbourGrid,
    { places, count, solids, radius, walls, isCandidate }: Neighbourhood,
    i: number,
    to: Float32Array,
  ): number {
    const { ranges, moments } = this;
    const { sorted, index } = grid;
    const scale = 1 / (kReach * radius);
    const [ox, oy, oz] = [places[3 * i]!, places[3 * i + 1]!, places[3 * i + 2]!];
    const mirrors = [
      mirrorsOf(walls, 0, ox, scale),
      mirrorsOf(walls, 1, oy, scale),
      mirrorsOf(walls, 2, oz, scale),
    ] as const;
    const hasMirrors = mirrors.some((all) => all.length > 0);
    moments.fill(0);
    grid.rangesAround(grid.cellOf[i]!, ranges);
    for (let n = 0; n < 18; n += 2) {
      for (let p = ranges[n]!, last = ranges[n + 1]!; p < last; ++p) {
        const dx = scale * (sorted[3 * p]! - ox);
        const dy = scale * (sorted[3 * p + 1]! - oy);
        const dz = scale * (sorted[3 * p + 2]! - oz);
        const remembered = isCandidate[index[p]!] ? index[p]! : -1;
        const isSolid = index[p]! >= count;
        const share = isSolid ? solids[index[p]! - count]! : 1;
        const weight = this.add(dx, dy, dz, share);
        if (weight > 0 && isSolid) this.addSolid(dx, dy, dz, weight);
        if (weight > 0 && remembered >= 0) this.remember(remembered, dx, dy, dz, weight);
        if (hasMirrors) this.addImages(remembered, [dx, dy, dz], share, mirrors);
      }
    }
    const sum = moments[0]!;
    const mean = (n: number): number => moments[n]! / sum;
    const [x, y, z] = [mean(1), mean(2), mean(3)];
    const products = [x * x, y * y, z * z, x * y, x * z, y * z];
    for (let n = 0; n < 6; ++n) to[n] = (mean(4 + n) - products[n]!) / kVariance;
    return sum;
  }

  /** Returns the extension of the particle towards the solids around it [particle radii]. */
  private touch(): [number, number, number] {
    const [sum, x, y, z] = this.moments.subarray(10) as unknown as [number, number, number, number];
    const length = Math.hypot(x, y, z);
    if (length === 0) return [0, 0, 0];
    const scale = (kExtension * smoothStep(kTouch, sum / kWithin)) / length;
    return [scale * x, scale * y, scale * z];
  }

  /** Adds a neighbour at a distance that is relative to the reach. Returns its weight. */
  private add(dx: number, dy: number, dz: number, share: number): number {
    const rest = 1 - dx * dx - dy * dy - dz * dz;
    if (rest <= 0) return 0;
    const { moments } = this;
    const w = share * rest * rest;
    moments[0]! += w;
    moments[1]! += w * dx;
    moments[2]! += w * dy;
    moments[3]! += w * dz;
    moments[4]! += w * dx * dx;
    moments[5]! += w * dy * dy;
    moments[6]! += w * dz * dz;
    moments[7]! += w * dx * dy;
    moments[8]! += w * dx * dz;
    moments[9]! += w * dy * dz;
    return w;
  }

  private addSolid(dx: number, dy: number, dz: number, weight: number): void {
    const { moments } = this;
    moments[10]! += weight;
    moments[11]! += weight * dx;
    moments[12]! += weight * dy;
    moments[13]! += weight * dz;
  }

  /**
   * Adds the mirror images of a neighbour. They have its distances in `near`, so that they do not
   * displace single particles towards a wall.
   */
  private addImages(
    j: number,
    [dx, dy, dz]: readonly [number, number, number],
    share: number,
    [across, along, up]: readonly [readonly number[], readonly number[], readonly number[]],
  ): void {
    for (let c = -1; c < up.length; ++c) {
      const z = c < 0 ? dz : up[c]! - dz;
      if (Math.abs(z) >= 1) continue;
      for (let b = -1; b < along.length; ++b) {
        const y = b < 0 ? dy : along[b]! - dy;
        if (Math.abs(y) >= 1) continue;
        for (let a = c < 0 && b < 0 ? 0 : -1; a < across.length; ++a) {
          const weight = this.add(a < 0 ? dx : across[a]! - dx, y, z, share);
          if (weight > 0 && j >= 0) this.remember(j, dx, dy, dz, weight);
        }
      }
    }
  }

  private remember(j: number, dx: number, dy: number, dz: number, weight: number): void {
    if (this.nears === this.nearIndex.length) {
      const [near, nearIndex] = [this.near, this.nearIndex];
      this.near = new Float32Array(2 * near.length);
      this.near.set(near);
      this.nearIndex = new Uint32Array(2 * nearIndex.length);
      this.nearIndex.set(nearIndex);
    }
    this.near[4 * this.nears] = dx;
    this.near[4 * this.nears + 1] = dy;
    this.near[4 * this.nears + 2] = dz;
    this.near[4 * this.nears + 3] = weight;
    this.nearIndex[this.nears++] = j;
  }

  /** Returns shape and displacement of the n-th candidate, particle i, with its neighbours. */
  private shape(
    at: Float32Array,
    starts: Uint32Array,
    n: number,
    i: number,
    variances: Float32Array,
  ): { shape: number[]; shift: number[] } {
    let [sum, x, y, z] = [0, 0, 0, 0];
    for (let k = starts[n]!, last = starts[n + 1]!; k < last; ++k) {
      const w = this.near[4 * k + 3]! * at[this.nearIndex[k]!]!;
      sum += w;
      x += w * this.near[4 * k]!;
      y += w * this.near[4 * k + 1]!;
      z += w * this.near[4 * k + 2]!;
    }
    const own = at[i]!;
    const [vx, vy, vz, xy, xz, yz] = variances as unknown as number[];
    const scale = sum > 0 ? (kFollow * kReach * own) / sum : 0;
    // Along the surface, the variance is that within the liquid, and there is no displacement.
    const shift = [
      scale * ((1 - vx!) * x - xy! * y - xz! * z),
      scale * ((1 - vy!) * y - xy! * x - yz! * z),
      scale * ((1 - vz!) * z - xz! * x - yz! * y),
    ];
    const flat = kFlat;
    const shape = [
      kSphere + flat * (vx! - 1),
      kSphere + flat * (vy! - 1),
      kSphere + flat * (vz! - 1),
      flat * xy!,
      flat * xz!,
      flat * yz!,
    ];
    return { shape, shift };
  }
}

/** The arguments of SurfaceShapes.write(), and which particles can be at the surface. */
interface Neighbourhood {
  places: ArrayLike<number>;
  count: number;
  solids: readonly number[];
  radius: number;
  walls: WallBox;
  isCandidate: Uint8Array;
}

/** Extends an ellipsoid by a vector, at one side only. */
function extend(shape: number[], shift: number[], by: Float32Array): void {
  const [x, y, z] = by as unknown as [number, number, number];
  const length = Math.hypot(x, y, z);
  if (length === 0) return;
  const half = 1 / (2 * length);
  [x * x, y * y, z * z, x * y, x * z, y * z].forEach((xx, n) => (shape[n]! += half * xx));
  [x, y, z].forEach((way, q) => (shift[q]! += 0.5 * way));
}

const kNone: readonly number[] = [];

/** Returns twice the distances of the walls within reach along an axis, relative to the reach. */
function mirrorsOf({ low, high }: WallBox, q: number, x: number, scale: number): readonly number[] {
  const [before, after] = [scale * (low[q]! - x), scale * (high[q]! - x)];
  if (before <= -1 && after >= 1) return kNone;
  return [2 * before, 2 * after].filter((away) => Math.abs(away) < 2);
}

/** Returns a shape in 16 bits for each entry, and a displacement in 10 bits for each coordinate. */
function pack(shape: readonly number[], shift: readonly number[]): number[] {
  const entry = (n: number): number => 0xffff & Math.round(32767 * unit(shape[n]! / kMostShape));
  const way = (q: number): number => 512 + Math.round(511 * unit(shift[q]! / kMostShift));
  return [
    ...[0, 2, 4].map((n) => (entry(n) | (entry(n + 1) << 16)) >>> 0),
    way(0) | (way(1) << 10) | (way(2) << 20),
  ];
}

function unit(value: number): number {
  return Math.min(Math.max(value, -1), 1);
}

/** Returns 0 below `low`, 1 above `high`, and a smooth transition between. */
function smoothStep([low, high]: readonly [number, number], value: number): number {
  const t = Math.min(Math.max((value - low) / (high - low), 0), 1);
  return t * t * (3 - 2 * t);
}
