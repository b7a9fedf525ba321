import { kNone } from './kept_particles.js';
import type { KeptParticles, Matched } from './kept_particles.js';
import { kInverses } from './neighbourhood.js';
import { kGrowth } from './room.js';

const kMostStep = 8191;
const kMostCounted = 63;
/** Marks an unknown step. */
const kNoStep = 1 << 30;

/** Predicts positions: protocol/FRAMES.md, "Positions". Reuses its memory. */
export class Motion {
  /** Steps since the second reference, three per remaining particle. */
  private steps = new Int32Array(0);
  /** By cell: sums of steps and their count; and the mean step of its neighbourhood [eighths]. */
  private sums = new Int32Array(0);
  private means = new Int32Array(0);
  /** The sums of three columns of nine cells, along x. */
  private readonly columns = new Int32Array(12);

  predict(matched: Matched, kept: KeptParticles, common: number, own: number): void {
    this.reserve(matched.first.count);
    this.gather(matched, kept);
    if (matched.second) this.findMeans(matched);
    else this.means.fill(0, 0, 3 * (matched.cells.cellCount + 1));
    this.extrapolate(matched, kept, common, own);
  }

  private reserve(count: number): void {
    if (this.steps.length >= 3 * count) return;
    const room = Math.ceil(kGrowth * count);
    this.steps = new Int32Array(3 * room);
    this.sums = new Int32Array(4 * (room + 1));
    this.means = new Int32Array(3 * (room + 1));
  }

  /** Stores positions and steps of the particles, and sums the steps of each cell. */
  private gather(
    { first, second, cells, secondPlaces, newPlaces }: Matched,
    { ends, targets, values }: KeptParticles,
  ): void {
    const { steps, sums } = this;
    const { order, begins, cellCount } = cells;
    const now = first.positions;
    const earlier = second ? second.positions : now;
    let count = 0;
    for (let c = 1; c <= cellCount; ++c) {
      const begin = begins[c]!;
      const end = begins[c + 1]!;
      const counted = (begin + kMostCounted) | 0;
      let sx = 0;
      let sy = 0;
      let sz = 0;
      let n = 0;
      for (let k = begin; k < end; ++k) {
        const i = order[k]!;
        const from = Math.imul(3, i);
        const x = now[from]!;
        const y = now[from + 1]!;
        const z = now[from + 2]!;
        let dx = kNoStep;
        let dy = 0;
        let dz = 0;
        const j = second ? secondPlaces[i]! : kNone;
        if (j >= 0) {
          const before = Math.imul(3, j);
          dx = (x - earlier[before]!) | 0;
          dy = (y - earlier[before + 1]!) | 0;
          dz = (z - earlier[before + 2]!) | 0;
          if (k < counted) {
            sx = (sx + bounded(dx)) | 0;
            sy = (sy + bounded(dy)) | 0;
            sz = (sz + bounded(dz)) | 0;
            n = (n + 1) | 0;
          }
        }
        const place = newPlaces[i]!;
        if (place < 0) continue;
        targets[count] = place;
        const at = Math.imul(3, count);
        count = (count + 1) | 0;
        values[at] = x;
        values[at + 1] = y;
        values[at + 2] = z;
        steps[at] = dx;
        steps[at + 1] = dy;
        steps[at + 2] = dz;
      }
      ends[c] = count;
      const to = c << 2;
      sums[to] = sx;
      sums[to + 1] = sy;
      sums[to + 2] = sz;
      sums[to + 3] = n;
    }
  }

  /** Computes the mean steps. Along x, 18 of the 27 neighbours are known from the previous cell. */
  private findMeans({ cells: { places, cellCount, numbers, row, layer } }: Matched): void {
    const { columns, means } = this;
    let [low, middle, high] = [0, 4, 8];
    let last = -1;
    for (let c = 1; c <= cellCount; ++c) {
      const place = places[c]!;
      if (place === last + 1) {
        const free = low;
        low = middle;
        middle = high;
        high = free;
      } else {
        this.sumColumn(numbers, place - 1, row, layer, low);
        this.sumColumn(numbers, place, row, layer, middle);
      }
      this.sumColumn(numbers, place + 1, row, layer, high);
      last = place;
      const n = columns[low + 3]! + columns[middle + 3]! + columns[high + 3]!;
      const inverse = kInverses[n]!;
      for (let q = 0; q < 3; ++q) {
        const sum = columns[low + q]! + columns[middle + q]! + columns[high + q]!;
        means[3 * c + q] = (sum * inverse) >> 13;
      }
    }
  }

  /** Sums the nine cells with the same x as this place. */
  private sumColumn(numbers: Int32Array, place: number, row: number, layer: number, to: number) {
    const { sums, columns } = this;
    let x = 0;
    let y = 0;
    let z = 0;
    let n = 0;
    for (let up = place - layer; up <= place + layer; up += layer) {
      for (let along = up - row; along <= up + row; along += row) {
        const at = numbers[along]! << 2;
        x += sums[at]!;
        y += sums[at + 1]!;
        z += sums[at + 2]!;
        n += sums[at + 3]!;
      }
    }
    put(columns, to, x, y, z);
    columns[to + 3] = n;
  }

  private extrapolate(
    { cells }: Matched,
    { ends, values }: KeptParticles,
    common: number,
    own: number,
  ): void {
    const { steps, means } = this;
    let at = 0;
    for (let c = 1; c <= cells.cellCount; ++c) {
      const mean = Math.imul(3, c);
      const mx = means[mean]!;
      const my = means[mean + 1]!;
      const mz = means[mean + 2]!;
      const cx = (Math.imul(common, mx) + 128) | 0;
      const cy = (Math.imul(common, my) + 128) | 0;
      const cz = (Math.imul(common, mz) + 128) | 0;
      const end = Math.imul(3, ends[c]!);
      for (; at < end; at += 3) {
        let bx = 0;
        let by = 0;
        let bz = 0;
        const dx = steps[at]!;
        if (dx !== kNoStep) {
          bx = ((dx << 3) - mx) | 0;
          by = ((steps[at + 1]! << 3) - my) | 0;
          bz = ((steps[at + 2]! << 3) - mz) | 0;
        }
        values[at] = (values[at]! << 3) + ((cx + Math.imul(own, bx)) >> 8);
        values[at + 1] = (values[at + 1]! << 3) + ((cy + Math.imul(own, by)) >> 8);
        values[at + 2] = (values[at + 2]! << 3) + ((cz + Math.imul(own, bz)) >> 8);
      }
    }
  }
}

// Short functions, which the engine compiles inline.

function put(array: Int32Array, at: number, x: number, y: number, z: number): void {
  array[at] = x;
  array[at + 1] = y;
  array[at + 2] = z;
}

function bounded(step: number): number {
  if ((step + kMostStep) >>> 0 <= 2 * kMostStep) return step;
  return step > 0 ? kMostStep : -kMostStep;
}
