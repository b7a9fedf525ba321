/** The box of a vat's walls [quanta]. Infinite where there is no wall. */
export interface WallBox {
  low: readonly number[];
  high: readonly number[];
}

/** Limit of the number of cells, relative to the number of particles. */
const kMostPerParticle = 8;
const kMostOfFew = 32_768;

/** Particles in cubic cells, for searches within the width of a cell. */
export class NeighbourGrid {
  /** Coordinates of the particles, ordered by cell. */
  readonly sorted: Float32Array;
  /** The index of each ordered particle among the given ones. */
  readonly index: Uint32Array;
  readonly cellOf: Int32Array;
  private readonly starts: Uint32Array;
  private readonly low = [Infinity, Infinity, Infinity];
  private readonly sizes: number[];
  private readonly width: number;

  /** `least` is the smallest width of a cell, in the unit of the coordinates. */
  constructor(places: ArrayLike<number>, count: number, least: number) {
    const high = [-Infinity, -Infinity, -Infinity];
    for (let q = 0; q < 3; ++q) {
      for (let i = q; i < 3 * count; i += 3) {
        if (places[i]! < this.low[q]!) this.low[q] = places[i]!;
        if (places[i]! > high[q]!) high[q] = places[i]!;
      }
    }
    const most = Math.max(kMostPerParticle * count, kMostOfFew);
    const sizesFor = (width: number): number[] =>
      this.low.map((l, q) => (count > 0 ? Math.floor((high[q]! - l) / width) : 0) + 3);
    let width = least;
    while (sizesFor(width).reduce((product, n) => product * n, 1) > most) width *= 1.25;
    this.width = width;
    this.sizes = sizesFor(width);
    const [nx, ny, nz] = this.sizes as [number, number, number];
    this.starts = new Uint32Array(nx * ny * nz + 1);
    this.cellOf = new Int32Array(count);
    const [lx, ly, lz] = this.low as [number, number, number];
    for (let i = 0; i < count; ++i) {
      const x = 1 + Math.floor((places[3 * i]! - lx) / width);
      const y = 1 + Math.floor((places[3 * i + 1]! - ly) / width);
      const z = 1 + Math.floor((places[3 * i + 2]! - lz) / width);
      const cell = x + nx * (y + ny * z);
      this.cellOf[i] = cell;
      ++this.starts[cell + 1]!;
    }
    for (let c = 1; c < this.starts.length; ++c) this.starts[c]! += this.starts[c - 1]!;
    this.sorted = new Float32Array(3 * count);
    this.index = new Uint32Array(count);
    const next = this.starts.slice();
    for (let i = 0; i < count; ++i) {
      const to = next[this.cellOf[i]!]!++;
      this.index[to] = i;
      this.sorted[3 * to] = places[3 * i]!;
      this.sorted[3 * to + 1] = places[3 * i + 1]!;
      this.sorted[3 * to + 2] = places[3 * i + 2]!;
    }
  }

  /**
   * Writes the ranges of ordered particles in the 27 cells around a cell: nine pairs of first and
   * last + 1.
   */
  rangesAround(cell: number, to: Uint32Array): void {
    const [nx, ny] = this.sizes as [number, number, number];
    let n = 0;
    for (let z = -1; z <= 1; ++z) {
      for (let y = -1; y <= 1; ++y) {
        const middle = cell + nx * (y + ny * z);
        to[n++] = this.starts[middle - 1]!;
        to[n++] = this.starts[middle + 2]!;
      }
    }
  }

  /** The number of cells. */
  get cells(): number {
    return this.starts.length - 1;
  }

  /** Returns the number of particles in the 27 cells around a cell. */
  countAround(cell: number): number {
    const [nx, ny] = this.sizes as [number, number, number];
    let count = 0;
    for (let z = -1; z <= 1; ++z) {
      for (let y = -1; y <= 1; ++y) {
        const middle = cell + nx * (y + ny * z);
        count += this.starts[middle + 2]! - this.starts[middle - 1]!;
      }
    }
    return count;
  }

  /** Returns the volume of the 27 cells around a cell that is within the walls. */
  volumeAround(cell: number, walls: WallBox): number {
    const [nx, ny] = this.sizes as [number, number, number];
    const at = [cell % nx, Math.floor(cell / nx) % ny, Math.floor(cell / (nx * ny))];
    let volume = 1;
    for (let q = 0; q < 3; ++q) {
      const low = Math.max(this.low[q]! + (at[q]! - 2) * this.width, walls.low[q]!);
      const high = Math.min(this.low[q]! + (at[q]! + 1) * this.width, walls.high[q]!);
      volume *= Math.max(high - low, 0);
    }
    return volume;
  }
}
