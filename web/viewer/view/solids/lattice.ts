/** The lattice of a body's particles at rest, and the links between neighbours. */

/** The axes, and the two sides of a particle on each. Direction 2 q + side. */
const kAxes = [0, 1, 2] as const;

const kNone = -1;

export class Lattice {
  readonly count: number;
  /** Integer coordinates, three for each particle. */
  readonly cells: Int32Array;
  /** Neighbours, six for each particle; -1 without a neighbour. */
  private readonly neighbours: Int32Array;
  /** Whether the link to the next particle along an axis is torn; three for each particle. */
  private readonly torn: Uint8Array;
  private tears = 0;

  constructor(
    rest: readonly number[],
    readonly spacing: number,
  ) {
    this.count = rest.length / 3;
    const first = kAxes.map((q) =>
      rest.reduce((least, x, i) => (i % 3 === q ? Math.min(least, x) : least), Infinity),
    );
    this.cells = Int32Array.from(rest, (x, i) => Math.round((x - first[i % 3]!) / spacing));
    this.neighbours = new Int32Array(6 * this.count).fill(kNone);
    this.torn = new Uint8Array(3 * this.count);
    const places = new Map<number, number>();
    for (let i = 0; i < this.count; ++i) places.set(this.keyOf(i, 0, 0), i);
    for (let i = 0; i < this.count; ++i) {
      for (const q of kAxes) {
        const next = places.get(this.keyOf(i, q, 1));
        if (next === undefined) continue;
        this.neighbours[6 * i + 2 * q + 1] = next;
        this.neighbours[6 * next + 2 * q] = i;
      }
    }
  }

  /** Returns the neighbour in a direction at rest; -1 without a neighbour. */
  neighbourAtRest(particle: number, direction: number): number {
    return this.neighbours[6 * particle + direction]!;
  }

  /** Returns the neighbour in a direction; -1 without a neighbour, or if the link is torn. */
  neighbour(particle: number, direction: number): number {
    const other = this.neighbours[6 * particle + direction]!;
    if (other === kNone || this.tears === 0) return other;
    const low = direction % 2 === 1 ? particle : other;
    return this.torn[3 * low + (direction >> 1)]! > 0 ? kNone : other;
  }

  /** Tears links longer than this at these positions. Returns whether any link has torn. */
  tear(places: ArrayLike<number>, length: number): boolean {
    const before = this.tears;
    for (let i = 0; i < this.count; ++i) {
      for (const q of kAxes) {
        const other = this.neighbours[6 * i + 2 * q + 1]!;
        if (other === kNone || this.torn[3 * i + q]! > 0) continue;
        const x = places[3 * other]! - places[3 * i]!;
        const y = places[3 * other + 1]! - places[3 * i + 1]!;
        const z = places[3 * other + 2]! - places[3 * i + 2]!;
        if (x * x + y * y + z * z <= length * length) continue;
        this.torn[3 * i + q] = 1;
        ++this.tears;
      }
    }
    return this.tears > before;
  }

  /** Restores all links. Returns whether any was torn. */
  mend(): boolean {
    const wasTorn = this.tears > 0;
    this.torn.fill(0);
    this.tears = 0;
    return wasTorn;
  }

  /** Returns a number for the cell `step` cells from a particle along an axis. */
  private keyOf(particle: number, axis: number, step: number): number {
    const at = (q: number): number => this.cells[3 * particle + q]! + (q === axis ? step : 0) + 1;
    return (at(0) * 65536 + at(1)) * 65536 + at(2);
  }
}
