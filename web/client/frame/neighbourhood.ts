import type { CellOrder } from './cell_order';
import { badBlock } from './frame_error';
import {
  advance,
  kCases,
  kClasses,
  kEscape,
  kTableBits,
  rangeOf,
  valueOf,
} from './residual_tables';
import { endsEarly, kLeastState } from './symbols';
import type { SymbolReader } from './symbols';

/** 65536 / n, rounded down. */
export const kInverses = Int32Array.from({ length: 2048 }, (_, n) => (n === 0 ? 0 : 65536 / n));

/** The class for residuals of which the mean magnitude is `size` / 2048. */
export function classOfSize(size: number): number {
  return rowOfSize(size) - 3;
}

/** No size is above 2047 * 65536 >> 8. */
const kRows = 56;

/** Of a cell: three sums of residuals, three of their sizes, the count; and the next one's place. */
const kSumBits = 3;
const kMostCounted = 63;
const kMostResidual = 8184;
const kMostSize = 2047;
const kNoMore = 1 << kTableBits;
const kTableMask = kNoMore - 1;

/** Which values are read, and within what bounds they have to be. */
export interface Wanted {
  /** By lane: whether anything is read. */
  readonly lanes: readonly boolean[];
  readonly least: number;
  readonly span: number;
}

/** What neighbours tell of a particle: protocol/PROTOCOL.md, "Neighbours". Keeps its memory. */
export class Neighbourhood {
  private cells = new Int32Array(0);
  private readonly before = new Int32Array(7);
  /** Of kCases what the row of a size stands for, and behind these what is read first. */
  private readonly kinds = new Uint16Array(8 * (kRows + 1));

  /**
   * Turns predictions [eighths], three of each particle cell by cell, into values. The particles of
   * cell c end before `ends[c]`.
   */
  read(
    symbols: SymbolReader,
    cells: CellOrder,
    ends: Uint32Array,
    values: Int32Array,
    wanted: Wanted,
  ): void {
    const { cellCount } = cells;
    this.tune(symbols.bits(3) - 4, symbols.residualClass());
    const room = (cellCount + 1) << kSumBits;
    if (this.cells.length < room) this.cells = new Int32Array(2 * room);
    let k = 0;
    for (let c = 1; c <= cellCount; ++c) {
      this.lookAround(cells, cells.places[c]!);
      const end = 3 * ends[c]!;
      this.readCell(symbols, values, k, end, c << kSumBits, wanted);
      k = end;
    }
  }

  private tune(shift: number, firstClass: number): void {
    for (let row = 0; row <= kRows; ++row) {
      const shifted = Math.min(Math.max(row - 3 + shift, 0), kClasses - 1);
      const index = row === kRows ? firstClass : shifted;
      for (let k = 0; k < 8; ++k) this.kinds[8 * row + k] = kCases[8 * index + k]!;
    }
  }

  /** Sums up the cells before this one; that without particles, number 0, has zeros. */
  private lookAround({ numbers, row, layer }: CellOrder, place: number): void {
    const { cells, before } = this;
    const a = numbers[place - 1]! << kSumBits;
    const b = numbers[place - row]! << kSumBits;
    const c = numbers[place - layer]! << kSumBits;
    for (let k = 0; k < 7; ++k) before[k] = cells[a + k]! + cells[b + k]! + cells[c + k]!;
  }

  /** The three lanes side by side, all they need in variables: half the time of a loop over them. */
  // eslint-disable-next-line max-lines-per-function
  private readCell(
    symbols: SymbolReader,
    values: Int32Array,
    begin: number,
    end: number,
    sums: number,
    { lanes, least, span }: Wanted,
  ): void {
    const { cells, before, kinds } = this;
    const { bytes, states } = symbols;
    const [has0, has1, has2] = [lanes[0]!, lanes[1]!, lanes[2]!];
    let next = symbols.next;
    let s0 = states[0]!;
    let s1 = states[1]!;
    let s2 = states[2]!;
    const left0 = before[0]!;
    const left1 = before[1]!;
    const left2 = before[2]!;
    const size0 = before[3]! + 8;
    const size1 = before[4]! + 8;
    const size2 = before[5]! + 8;
    const known = before[6]!;
    let e0 = 0;
    let e1 = 0;
    let e2 = 0;
    let z0 = 0;
    let z1 = 0;
    let z2 = 0;
    let count = 0;
    for (let k = begin; k < end; k += 3) {
      const inverse = kInverses[(count << 2) + known + 1]!;
      const p0 = values[k]!;
      const p1 = values[k + 1]!;
      const p2 = values[k + 2]!;
      const a0 = (z0 << 2) + size0;
      const a1 = (z1 << 2) + size1;
      const a2 = (z2 << 2) + size2;
      const all = a0 + a1 + a2;
      const isFirst = count + known === 0;

      const m0 = p0 + (Math.imul((e0 << 2) + left0, inverse) >> 16);
      const m1 = p1 + (Math.imul((e1 << 2) + left1, inverse) >> 16);
      const m2 = p2 + (Math.imul((e2 << 2) + left2, inverse) >> 16);
      let r0 = 0;
      let r1 = 0;
      let r2 = 0;
      if (has0) {
        const mean = Math.imul((Math.imul(13, a0) + all) >> 4, inverse) >> 8;
        const row = isFirst ? kRows : rowOfSize(mean);
        const kind = kinds[(row << 3) | ((m0 + 4) & 7)]!;
        const range = rangeOf(kind & kTableMask, s0);
        s0 = advance(s0, range);
        if (s0 < kLeastState) {
          s0 = (s0 << 16) | bytes[next]! | (bytes[next + 1]! << 8);
          next += 2;
        }
        r0 = valueOf(range);
        if (kind >= kNoMore || r0 === kEscape) {
          states[0] = s0;
          symbols.next = next;
          r0 = symbols.completed(kind, r0, 0);
          s0 = states[0]!;
          next = symbols.next;
        }
      }
      if (has1) {
        const mean = Math.imul((Math.imul(13, a1) + all) >> 4, inverse) >> 8;
        const row = isFirst ? kRows : rowOfSize(mean);
        const kind = kinds[(row << 3) | ((m1 + 4) & 7)]!;
        const range = rangeOf(kind & kTableMask, s1);
        s1 = advance(s1, range);
        if (s1 < kLeastState) {
          s1 = (s1 << 16) | bytes[next]! | (bytes[next + 1]! << 8);
          next += 2;
        }
        r1 = valueOf(range);
        if (kind >= kNoMore || r1 === kEscape) {
          states[1] = s1;
          symbols.next = next;
          r1 = symbols.completed(kind, r1, 1);
          s1 = states[1]!;
          next = symbols.next;
        }
      }
      if (has2) {
        const mean = Math.imul((Math.imul(13, a2) + all) >> 4, inverse) >> 8;
        const row = isFirst ? kRows : rowOfSize(mean);
        const kind = kinds[(row << 3) | ((m2 + 4) & 7)]!;
        const range = rangeOf(kind & kTableMask, s2);
        s2 = advance(s2, range);
        if (s2 < kLeastState) {
          s2 = (s2 << 16) | bytes[next]! | (bytes[next + 1]! << 8);
          next += 2;
        }
        r2 = valueOf(range);
        if (kind >= kNoMore || r2 === kEscape) {
          states[2] = s2;
          symbols.next = next;
          r2 = symbols.completed(kind, r2, 2);
          s2 = states[2]!;
          next = symbols.next;
        }
      }
      if (next > bytes.length) endsEarly(); // zeros were read in place of what is not there
      const v0 = valueNear(m0, r0);
      const v1 = valueNear(m1, r1);
      const v2 = valueNear(m2, r2);
      if (isOutside(v0, least, span) || isOutside(v1, least, span) || isOutside(v2, least, span)) {
        badBlock('a position is outside the grid, or an attribute too large');
      }
      values[k] = v0;
      values[k + 1] = v1;
      values[k + 2] = v2;
      if (count === kMostCounted) continue;
      ++count;
      e0 += bounded((v0 << 3) - p0);
      e1 += bounded((v1 << 3) - p1);
      e2 += bounded((v2 << 3) - p2);
      z0 += sizeOf((v0 << 3) - m0);
      z1 += sizeOf((v1 << 3) - m1);
      z2 += sizeOf((v2 << 3) - m2);
    }
    symbols.next = next;
    states[0] = s0;
    states[1] = s1;
    states[2] = s2;
    cells[sums] = e0;
    cells[sums + 1] = e1;
    cells[sums + 2] = e2;
    cells[sums + 3] = z0;
    cells[sums + 4] = z1;
    cells[sums + 5] = z2;
    cells[sums + 6] = count;
  }
}

// Short, to be compiled in place.

function rowOfSize(size: number): number {
  const least = Math.max(size, 64);
  const octave = 25 - Math.clz32(least);
  return (octave << 2) + ((least >> (octave + 4)) & 3);
}

/** The value at a residual from a prediction [eighths]. */
function valueNear(eighths: number, residual: number): number {
  const whole = (eighths + 4) >> 3;
  const turn = (eighths - (whole << 3)) >> 31;
  return (whole + ((residual ^ turn) - turn)) | 0;
}

function isOutside(value: number, least: number, span: number): boolean {
  return (value - least) >>> 0 > span;
}

function bounded(residual: number): number {
  if (residual > kMostResidual) return kMostResidual;
  return residual < -kMostResidual ? -kMostResidual : residual;
}

function sizeOf(off: number): number {
  const size = off < 0 ? -off : off;
  return size > kMostSize ? kMostSize : size;
}
