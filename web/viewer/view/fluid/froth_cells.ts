/** Width of a cell [particle radii]. 27 full cells contain about 90 particles. */
const kWidth = 3;
/** The maximum number of cells per particle, and of a liquid with few particles. */
const kMostPerParticle = 16;
const kMostOfFew = 32_768;
/** Limits of the number of particles in 27 cells within a liquid, which is flat in some scenes. */
const kFull = [12, 90] as const;

/** The neighbourhood of a particle: the cell that contains it, and the 26 cells around it. */
export interface Neighbourhood {
  /** Number of particles relative to the number within the liquid. */
  neighbours: number;
  /** Standard deviation of the ways of the particles between two frames [quanta]. */
  deviation: number;
  /** The way of the particle itself [quanta]. */
  way: number;
}

/** Coordinates in the newest and the previous frame [quanta]. */
interface Places {
  center: Uint16Array;
  before: Uint16Array;
}

type Sums = Record<'count' | 'x' | 'y' | 'z' | 'squares', Float32Array>;

/** Numbers and ways of particles, summed over 27 cells. */
export class FrothCells {
  private readonly cellOf: Int32Array;
  private readonly sums: Sums;
  private readonly full: number;
  private readonly found: Neighbourhood = { neighbours: 0, deviation: 0, way: 0 };

  /** `radius` is that of the particles [quanta]. */
  constructor(
    private readonly places: Places,
    count: number,
    radius: number,
  ) {
    const { low, sizes, width } = gridOf(places.center, count, kWidth * radius);
    const [first, second] = [sizes[0]!, sizes[0]! * sizes[1]!];
    const cells = second * sizes[2]!;
    const column = (): Float32Array => new Float32Array(cells);
    this.sums = { count: column(), x: column(), y: column(), z: column(), squares: column() };
    this.cellOf = new Int32Array(count);
    for (let i = 0; i < count; ++i) {
      const at = (q: number): number =>
        1 + Math.floor((places.center[3 * i + q]! - low[q]!) / width);
      this.add(i, at(0) + first * at(1) + second * at(2));
    }
    for (const values of Object.values(this.sums)) {
      for (const stride of [1, first, second]) sumOfThree(values, stride);
    }
    let most = 0;
    for (const cell of this.cellOf) most = Math.max(most, this.sums.count[cell]!);
    const larger = (width / (kWidth * radius)) ** 3;
    this.full = Math.min(Math.max(most, kFull[0]), larger * kFull[1]);
  }

  /** Returns the neighbourhood of a particle. The next call overwrites it. */
  around(particle: number): Readonly<Neighbourhood> {
    const { found, sums } = this;
    const cell = this.cellOf[particle]!;
    const count = sums.count[cell]!;
    const mean2 = (sums.x[cell]! ** 2 + sums.y[cell]! ** 2 + sums.z[cell]! ** 2) / count ** 2;
    found.neighbours = (count - 1) / this.full;
    found.deviation = Math.sqrt(Math.max(sums.squares[cell]! / count - mean2, 0));
    const [x, y, z] = this.wayOf(particle);
    found.way = Math.sqrt(x * x + y * y + z * z);
    return found;
  }

  private add(particle: number, cell: number): void {
    const { sums } = this;
    const [x, y, z] = this.wayOf(particle);
    this.cellOf[particle] = cell;
    sums.count[cell]! += 1;
    sums.x[cell]! += x;
    sums.y[cell]! += y;
    sums.z[cell]! += z;
    sums.squares[cell]! += x * x + y * y + z * z;
  }

  private wayOf(i: number): [number, number, number] {
    const { center, before } = this.places;
    const way = (at: number): number => center[at]! - before[at]!;
    return [way(3 * i), way(3 * i + 1), way(3 * i + 2)];
  }
}

/** Returns a grid with one empty layer of cells on each side, so that sums need no conditions. */
function gridOf(
  places: Uint16Array,
  count: number,
  least: number,
): { low: number[]; sizes: number[]; width: number } {
  const low = [65535, 65535, 65535];
  const high = [0, 0, 0];
  for (let q = 0; q < 3; ++q) {
    for (let i = q; i < 3 * count; i += 3) {
      if (places[i]! < low[q]!) low[q] = places[i]!;
      if (places[i]! > high[q]!) high[q] = places[i]!;
    }
  }
  const most = Math.max(kMostPerParticle * count, kMostOfFew);
  for (let width = least; ; width *= 1.25) {
    const sizes = low.map((l, q) => Math.max(Math.floor((high[q]! - l) / width), 0) + 3);
    if (sizes[0]! * sizes[1]! * sizes[2]! <= most) return { low, sizes, width };
  }
}

/** Adds to each value its neighbours at distance `stride`, except at the ends. */
function sumOfThree(values: Float32Array, stride: number): void {
  const own = values.slice();
  for (let i = stride; i < values.length - stride; ++i) {
    values[i] = own[i]! + own[i - stride]! + own[i + stride]!;
  }
}
