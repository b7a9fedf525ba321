import type { CellOrder } from './cell_order';
import { kClasses } from './residual_tables';

/** 65536 / n, rounded down. */
export const kInverses = Int32Array.from({ length: 2048 }, (_, n) => (n === 0 ? 0 : 65536 / n));

/** The class for residuals of which the mean magnitude is `size` / 2048. */
export function classOfSize(size: number): number {
  const s = size < 64 ? 64 : size;
  const octave = 25 - Math.clz32(s);
  return 4 * octave + ((s >> (octave + 4)) & 3) - 3;
}

const kMostCounted = 63;
const kMostResidual = 8184;
const kMostSize = 2047;
/** Of a cell: how many particles, three sums of residuals, three of their sizes. */
const kSums = 7;

/** What neighbours tell of a particle: protocol/PROTOCOL.md, "Neighbours". */
export class Neighbourhood {
  readonly wholes = new Int32Array(3);
  readonly fractions = new Int32Array(3);
  readonly classes = new Int32Array(3);
  private cells = new Int32Array(0);
  private readonly before = new Int32Array(kSums);
  private readonly own = new Int32Array(kSums);
  private shift = 0;
  private firstClass = 0;

  start(cellCount: number, shift: number, firstClass: number): void {
    const size = kSums * (cellCount + 1);
    if (this.cells.length < size) this.cells = new Int32Array(2 * size);
    else this.cells.fill(0, 0, size);
    this.shift = shift;
    this.firstClass = firstClass;
  }

  enter(cells: CellOrder, place: number): void {
    const { before, own } = this;
    const a = kSums * (cells.numbers[place - 1] as number);
    const b = kSums * (cells.numbers[place - cells.row] as number);
    const c = kSums * (cells.numbers[place - cells.layer] as number);
    const sums = this.cells;
    for (let k = 0; k < kSums; ++k) {
      before[k] = (sums[a + k] as number) + (sums[b + k] as number) + (sums[c + k] as number);
      own[k] = 0;
    }
  }

  leave(cell: number): void {
    this.cells.set(this.own, kSums * cell);
  }

  /** Where the values are expected, from predictions [eighths]. */
  expect(predictions: Int32Array): void {
    const { before, own, wholes, fractions, classes } = this;
    const ownCount = own[0] as number;
    const beforeCount = before[0] as number;
    const inverse = kInverses[4 * ownCount + beforeCount + 1] as number;
    const sx = 4 * (own[4] as number) + (before[4] as number) + 8;
    const sy = 4 * (own[5] as number) + (before[5] as number) + 8;
    const sz = 4 * (own[6] as number) + (before[6] as number) + 8;
    const all = sx + sy + sz;
    const isFirst = ownCount + beforeCount === 0;
    for (let q = 0; q < 3; ++q) {
      const residual = 4 * (own[1 + q] as number) + (before[1 + q] as number);
      const middle = (predictions[q] as number) + ((residual * inverse) >> 16);
      const whole = (middle + 4) >> 3;
      wholes[q] = whole;
      fractions[q] = middle - 8 * whole;
      const size = q === 0 ? sx : q === 1 ? sy : sz;
      const index = classOfSize((((13 * size + all) >> 4) * inverse) >> 8) + this.shift;
      classes[q] = isFirst ? this.firstClass : index < 0 ? 0 : Math.min(index, kClasses - 1);
    }
  }

  learn(predictions: Int32Array, values: Int32Array): void {
    const { own, wholes, fractions } = this;
    const count = own[0] as number;
    if (count === kMostCounted) return;
    own[0] = count + 1;
    for (let q = 0; q < 3; ++q) {
      const value = values[q] as number;
      const residual = 8 * value - (predictions[q] as number);
      const off = Math.abs(8 * (value - (wholes[q] as number)) - (fractions[q] as number));
      const bounded =
        residual > kMostResidual
          ? kMostResidual
          : residual < -kMostResidual
            ? -kMostResidual
            : residual;
      own[1 + q] = (own[1 + q] as number) + bounded;
      own[4 + q] = (own[4 + q] as number) + (off > kMostSize ? kMostSize : off);
    }
  }
}
