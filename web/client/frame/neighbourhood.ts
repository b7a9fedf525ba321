import type { CellOrder } from './cell_order.js';
import { badBlock } from './frame_error.js';
import { kCases, kClasses, kEscape, kRanges, kResiduals } from './residual_tables.js';
import { kResidualBits, kSlotBits, kTableBits } from './residual_tables.js';
import { endsEarly, kLeastState } from './symbols.js';
import type { SymbolReader } from './symbols.js';

/** 65536 / n, rounded down. */
export const kInverses = Int32Array.from({ length: 2048 }, (_, n) => (n === 0 ? 0 : 65536 / n));

/** Returns the class for residuals with a mean magnitude of `size` / 2048. */
export function classOfSize(size: number): number {
  return rowOfSize(size) - 3;
}

/** By size / 16, for sizes below 2 ** 19: the begin of its row in `kinds`. */
const kRowBegins = Uint16Array.from({ length: 1 << 15 }, (_, k) => rowOfSize(k << 4) << 3);
const kRows = 56;
/** The last row: values without context. */
const kFirstRow = kRows << 3;

/** Bits of the index of a cell's eight elements: residual sums, size sums, count, next place. */
const kSumBits = 3;
const kMostCounted = 63;
const kMostResidual = 8184;
const kMostSize = 2047;
const kTableMask = (1 << kTableBits) - 1;
const kSlotMask = (1 << kSlotBits) - 1;
const kResidualMask = (1 << kResidualBits) - 1;

/** Which values are read, and their bounds. */
export interface Wanted {
  /** By lane: whether it is read. */
  readonly lanes: readonly boolean[];
  readonly least: number;
  readonly span: number;
}

/**
 * Predictions from neighbouring cells: protocol/FRAMES.md, "Context of neighbouring cells". Reuses
 * its memory.
 */
export class Neighbourhood {
  private sums = new Int32Array(0);
  /** The elements of kCases for each row of sizes, followed by those of values without context. */
  private readonly kinds = new Uint16Array(8 * (kRows + 1));

  /**
   * Turns predictions [eighths], three of each particle cell by cell, into values. The particles of
   * cell c end before `ends[c]`.
   *
   * Decoding spends half of its time here. Therefore the three lanes are unrolled, their state is in
   * variables, no function is called, and unpredictable decisions do not branch.
   */
  // eslint-disable-next-line max-lines-per-function
  read(
    symbols: SymbolReader,
    { cellCount, places, numbers, row, layer }: CellOrder,
    ends: Int32Array,
    values: Int32Array,
    { lanes, least, span }: Wanted,
  ): void {
    this.tune(symbols.bits(3) - 4, symbols.residualClass());
    this.reserve(cellCount);
    const { sums, kinds } = this;
    const { words, wordCount, states } = symbols;
    const inverses = kInverses;
    const rows = kRowBegins;
    const residuals = kResiduals;
    const ranges = kRanges;
    const [has0, has1, has2] = [lanes[0] === true, lanes[1] === true, lanes[2] === true];
    let next = symbols.next;
    let s0 = states[0]!;
    let s1 = states[1]!;
    let s2 = states[2]!;
    let k = 0;
    for (let c = 1; c <= cellCount; ++c) {
      const place = places[c]!;
      const a = numbers[place - 1]! << kSumBits; // number 0, the empty cell, contains zeros
      const b = numbers[place - row]! << kSumBits;
      const d = numbers[place - layer]! << kSumBits;
      const left0 = (sums[a]! + sums[b]! + sums[d]!) | 0;
      const left1 = (sums[a + 1]! + sums[b + 1]! + sums[d + 1]!) | 0;
      const left2 = (sums[a + 2]! + sums[b + 2]! + sums[d + 2]!) | 0;
      const size0 = (sums[a + 3]! + sums[b + 3]! + sums[d + 3]! + 8) | 0;
      const size1 = (sums[a + 4]! + sums[b + 4]! + sums[d + 4]! + 8) | 0;
      const size2 = (sums[a + 5]! + sums[b + 5]! + sums[d + 5]! + 8) | 0;
      const known = (sums[a + 6]! + sums[b + 6]! + sums[d + 6]! + 1) | 0;
      // The neighbours' sums plus four times the cell's sums.
      let e0 = left0;
      let e1 = left1;
      let e2 = left2;
      let z0 = size0;
      let z1 = size1;
      let z2 = size2;
      let count = known;
      const most = (known + 4 * kMostCounted) | 0;
      const end = 3 * ends[c]!;
      for (; k < end; k += 3) {
        const inverse = inverses[count]!;
        const isFirst = count === 1;
        const all = (z0 + z1 + z2) | 0;
        const p0 = values[k]!;
        const p1 = values[k + 1]!;
        const p2 = values[k + 2]!;
        const m0 = (p0 + (Math.imul(e0, inverse) >> 16)) | 0;
        const m1 = (p1 + (Math.imul(e1, inverse) >> 16)) | 0;
        const m2 = (p2 + (Math.imul(e2, inverse) >> 16)) | 0;
        const f0 = (m0 + 4) & 7; // the fraction plus 4
        const f1 = (m1 + 4) & 7;
        const f2 = (m2 + 4) & 7;
        let r0 = 0;
        let r1 = 0;
        let r2 = 0;
        if (has0) {
          const size = Math.imul((Math.imul(13, z0) + all) >> 4, inverse) >> 8;
          const kind = kinds[(isFirst ? kFirstRow : rows[size >> 4]!) | f0]!;
          const table = kind & kTableMask;
          const slot = s0 & kSlotMask;
          r0 = residuals[(table << kSlotBits) | slot]!;
          const range = ranges[(table << kResidualBits) | (r0 & kResidualMask)]!;
          s0 = (Math.imul(range >>> 16, s0 >> kSlotBits) + slot - (range & 0xffff)) | 0;
          const more = (s0 - kLeastState) >> 31; // -1 if the lane needs a word
          s0 = (s0 << (more & 16)) | (words[next]! & more);
          next = (next - more) | 0;
          if (kind > kTableMask || r0 === kEscape) {
            states[0] = s0;
            symbols.next = next;
            r0 = symbols.completed(kind, r0, 0);
            s0 = states[0]!;
            next = symbols.next;
          }
        }
        if (has1) {
          const size = Math.imul((Math.imul(13, z1) + all) >> 4, inverse) >> 8;
          const kind = kinds[(isFirst ? kFirstRow : rows[size >> 4]!) | f1]!;
          const table = kind & kTableMask;
          const slot = s1 & kSlotMask;
          r1 = residuals[(table << kSlotBits) | slot]!;
          const range = ranges[(table << kResidualBits) | (r1 & kResidualMask)]!;
          s1 = (Math.imul(range >>> 16, s1 >> kSlotBits) + slot - (range & 0xffff)) | 0;
          const more = (s1 - kLeastState) >> 31; // -1 if the lane needs a word
          s1 = (s1 << (more & 16)) | (words[next]! & more);
          next = (next - more) | 0;
          if (kind > kTableMask || r1 === kEscape) {
            states[1] = s1;
            symbols.next = next;
            r1 = symbols.completed(kind, r1, 1);
            s1 = states[1]!;
            next = symbols.next;
          }
        }
        if (has2) {
          const size = Math.imul((Math.imul(13, z2) + all) >> 4, inverse) >> 8;
          const kind = kinds[(isFirst ? kFirstRow : rows[size >> 4]!) | f2]!;
          const table = kind & kTableMask;
          const slot = s2 & kSlotMask;
          r2 = residuals[(table << kSlotBits) | slot]!;
          const range = ranges[(table << kResidualBits) | (r2 & kResidualMask)]!;
          s2 = (Math.imul(range >>> 16, s2 >> kSlotBits) + slot - (range & 0xffff)) | 0;
          const more = (s2 - kLeastState) >> 31; // -1 if the lane needs a word
          s2 = (s2 << (more & 16)) | (words[next]! & more);
          next = (next - more) | 0;
          if (kind > kTableMask || r2 === kEscape) {
            states[2] = s2;
            symbols.next = next;
            r2 = symbols.completed(kind, r2, 2);
            s2 = states[2]!;
            next = symbols.next;
          }
        }
        if (next > wordCount) endsEarly(); // words beyond the end were read
        const t0 = (f0 - 4) >> 31; // -1 negates the residual
        const t1 = (f1 - 4) >> 31;
        const t2 = (f2 - 4) >> 31;
        const v0 = (((m0 + 4) >> 3) + (r0 ^ t0) - t0) | 0;
        const v1 = (((m1 + 4) >> 3) + (r1 ^ t1) - t1) | 0;
        const v2 = (((m2 + 4) >> 3) + (r2 ^ t2) - t2) | 0;
        if ((v0 - least) >>> 0 > span || (v1 - least) >>> 0 > span || (v2 - least) >>> 0 > span) {
          badBlock('a position is outside the grid, or an attribute too large');
        }
        values[k] = v0;
        values[k + 1] = v1;
        values[k + 2] = v2;
        if (count === most) continue;
        count = (count + 4) | 0;
        e0 = (e0 + (bounded((v0 << 3) - p0) << 2)) | 0;
        e1 = (e1 + (bounded((v1 << 3) - p1) << 2)) | 0;
        e2 = (e2 + (bounded((v2 << 3) - p2) << 2)) | 0;
        z0 = (z0 + (sizeOf((v0 << 3) - m0) << 2)) | 0;
        z1 = (z1 + (sizeOf((v1 << 3) - m1) << 2)) | 0;
        z2 = (z2 + (sizeOf((v2 << 3) - m2) << 2)) | 0;
      }
      const at = c << kSumBits;
      sums[at] = (e0 - left0) >> 2;
      sums[at + 1] = (e1 - left1) >> 2;
      sums[at + 2] = (e2 - left2) >> 2;
      sums[at + 3] = (z0 - size0) >> 2;
      sums[at + 4] = (z1 - size1) >> 2;
      sums[at + 5] = (z2 - size2) >> 2;
      sums[at + 6] = (count - known) >> 2;
    }
    symbols.next = next;
    states[0] = s0;
    states[1] = s1;
    states[2] = s2;
  }

  private reserve(cellCount: number): void {
    const room = (cellCount + 1) << kSumBits;
    if (this.sums.length < room) this.sums = new Int32Array(2 * room);
  }

  private tune(shift: number, firstClass: number): void {
    for (let row = 0; row <= kRows; ++row) {
      const shifted = Math.min(Math.max(row - 3 + shift, 0), kClasses - 1);
      const index = row === kRows ? firstClass : shifted;
      for (let k = 0; k < 8; ++k) this.kinds[8 * row + k] = kCases[8 * index + k]!;
    }
  }
}

function rowOfSize(size: number): number {
  const least = Math.max(size, 64);
  const octave = 25 - Math.clz32(least);
  return (octave << 2) + ((least >> (octave + 4)) & 3);
}

// Short functions, which the engine compiles inline.

function bounded(residual: number): number {
  if (residual > kMostResidual) return kMostResidual;
  return residual < -kMostResidual ? -kMostResidual : residual;
}

function sizeOf(off: number): number {
  const size = off < 0 ? -off : off;
  return size > kMostSize ? kMostSize : size;
}
