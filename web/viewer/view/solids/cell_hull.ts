import type { Lattice } from './lattice';

/** The quads around the cells of a lattice. Cells that are linked share their corners. */
export interface CellHull {
  /** Four corners per quad, counter-clockwise seen from outside. */
  quads: number[];
  /** The particle inside of each quad. */
  particles: number[];
  /** Whether the quad exists at rest: it is not a side of a tear. */
  isOuter: boolean[];
  /** The particles whose cells meet at each corner, with the corner's place in the cell. */
  corners: { particle: number; bits: number }[][];
}

/** Corners of the six sides of a cell: bit q is the side on axis q. */
const kSides = [
  [0, 4, 6, 2],
  [1, 3, 7, 5],
  [0, 1, 5, 4],
  [2, 6, 7, 3],
  [0, 2, 3, 1],
  [4, 5, 7, 6],
] as const;

const kNone = -1;

/** Returns the surface of all cells. A tear separates corners that no linked cells join. */
export function hullOf(lattice: Lattice): CellHull {
  const hull: CellHull = { quads: [], particles: [], isOuter: [], corners: [] };
  const known = new Map<number, number>();
  for (let particle = 0; particle < lattice.count; ++particle) {
    for (let direction = 0; direction < 6; ++direction) {
      if (lattice.neighbour(particle, direction) !== kNone) continue;
      for (const bits of kSides[direction]!) {
        hull.quads.push(cornerOf(lattice, particle, bits, hull, known));
      }
      hull.particles.push(particle);
      hull.isOuter.push(lattice.neighbourAtRest(particle, direction) === kNone);
    }
  }
  return hull;
}

function cornerOf(
  lattice: Lattice,
  particle: number,
  bits: number,
  hull: CellHull,
  known: Map<number, number>,
): number {
  const there = known.get(8 * particle + bits);
  if (there !== undefined) return there;
  const index = hull.corners.length;
  const meeting = cellsAround(lattice, particle, bits);
  for (const { particle: one, bits: place } of meeting) known.set(8 * one + place, index);
  hull.corners.push(meeting);
  return index;
}

/** Returns the cells at a corner that links between them join to a cell. */
function cellsAround(
  lattice: Lattice,
  particle: number,
  bits: number,
): { particle: number; bits: number }[] {
  const found = [{ particle, bits }];
  for (let next = 0; next < found.length; ++next) {
    const from = found[next]!;
    for (let q = 0; q < 3; ++q) {
      const side = (from.bits >> q) & 1;
      const other = lattice.neighbour(from.particle, 2 * q + side);
      if (other === kNone || found.some((one) => one.particle === other)) continue;
      found.push({ particle: other, bits: from.bits ^ (1 << q) });
    }
  }
  return found;
}
