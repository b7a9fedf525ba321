import type { Lattice } from './lattice';

const kNone = -1;

/**
 * Writes the columns of the deformation at each particle: the vectors to its next neighbours along
 * the axes of rest, nine numbers each. Links give them as mean differences. Directions without
 * links, of sheets, threads and single particles, are perpendicular to the others.
 */
export function measureFrames(
  lattice: Lattice,
  places: ArrayLike<number>,
  unit: number,
  frames: Float32Array,
): void {
  for (let i = 0; i < lattice.count; ++i) {
    let known = 0;
    for (let q = 0; q < 3; ++q) {
      const before = lattice.neighbour(i, 2 * q);
      const after = lattice.neighbour(i, 2 * q + 1);
      if (before === kNone && after === kNone) continue;
      const from = 3 * (before === kNone ? i : before);
      const to = 3 * (after === kNone ? i : after);
      const factor = before !== kNone && after !== kNone ? 0.5 : 1;
      const at = 9 * i + 3 * q;
      frames[at] = factor * (places[to]! - places[from]!);
      frames[at + 1] = factor * (places[to + 1]! - places[from + 1]!);
      frames[at + 2] = factor * (places[to + 2]! - places[from + 2]!);
      known |= 1 << q;
    }
    if (known !== 7) complete(frames, 9 * i, known, unit);
  }
}

/** Adds the unknown columns of a frame. `known` has a bit for each column. */
function complete(frames: Float32Array, at: number, known: number, unit: number): void {
  const isKnown = (q: number): boolean => (known & (1 << q)) !== 0;
  const axes = [0, 1, 2];
  const count = axes.filter(isKnown).length;
  if (count === 0) {
    for (const q of axes)
      setColumn(frames, at, q, q === 0 ? unit : 0, q === 1 ? unit : 0, q === 2 ? unit : 0);
    return;
  }
  if (count === 1) {
    // The axis of rest that is most across the known column, made perpendicular.
    const q = axes.find(isKnown)!;
    const column = at + 3 * q;
    const length = Math.hypot(frames[column]!, frames[column + 1]!, frames[column + 2]!) || unit;
    const next = (q + 1) % 3;
    const sizes = axes.map((axis) => Math.abs(frames[column + axis]!));
    const across = sizes[next]! < 0.9 * length ? next : (q + 2) % 3;
    const part = frames[column + across]! / length;
    const way = axes.map(
      (axis) => (axis === across ? 1 : 0) - (part * frames[column + axis]!) / length,
    );
    const scale = length / (Math.hypot(...way) || 1);
    setColumn(frames, at, next, scale * way[0]!, scale * way[1]!, scale * way[2]!);
    known |= 1 << next;
  }
  const q = axes.find((axis) => (known & (1 << axis)) === 0)!;
  const a = at + 3 * ((q + 1) % 3);
  const b = at + 3 * ((q + 2) % 3);
  const x = frames[a + 1]! * frames[b + 2]! - frames[a + 2]! * frames[b + 1]!;
  const y = frames[a + 2]! * frames[b]! - frames[a]! * frames[b + 2]!;
  const z = frames[a]! * frames[b + 1]! - frames[a + 1]! * frames[b]!;
  const scale = unit / (Math.hypot(x, y, z) || 1);
  setColumn(frames, at, q, scale * x, scale * y, scale * z);
}

function setColumn(
  frames: Float32Array,
  at: number,
  column: number,
  x: number,
  y: number,
  z: number,
): void {
  frames[at + 3 * column] = x;
  frames[at + 3 * column + 1] = y;
  frames[at + 3 * column + 2] = z;
}
