import type { BlockData } from './block_data.js';
import { kAttributes } from './block_data.js';
import { badBlock } from './frame_error.js';
import { classOfSize } from './neighbourhood.js';
import { kClasses, kLeastKeyClass } from './residual_tables.js';
import { kGrowth } from './room.js';
import type { SymbolReader } from './symbols.js';

const kFirstClass = kClasses - 1;
const kMostSize = 131064;
const kMiddleOfGrid = 32768;
export const kMostAttribute = 1 << 20;

/** Added particles: protocol/FRAMES.md, "New particles". Reuses its memory. */
export class AddedParticles {
  /** Their indices in the block, and their numbers. The first `count` elements are valid. */
  places = new Uint32Array(0);
  numbers = new Uint32Array(0);
  count = 0;
  private sizes = new Int32Array(0);
  private readonly strides: number[] = [];

  reserve(count: number): void {
    this.count = count;
    if (this.places.length >= count) return;
    const room = Math.ceil(kGrowth * count);
    this.places = new Uint32Array(room);
    this.numbers = new Uint32Array(room);
    this.sizes = new Int32Array(3 * room);
  }

  readNumbers(symbols: SymbolReader, into: Uint32Array): void {
    if (this.count === 0) return;
    const chances = symbols.bits(12);
    const order = symbols.bits(5);
    if (chances === 0) badBlock('its numbers have the probability 0');
    let next = 0;
    for (let i = 0; i < this.count; ++i) {
      if (!symbols.flag(chances)) next += 1 + readGap(symbols, order);
      if (next > 0xffffffff) badBlock('a number has more than 32 bits');
      into[i] = next++;
    }
  }

  read(symbols: SymbolReader, block: BlockData): void {
    if (this.count === 0) return;
    this.readStrides(symbols);
    this.readPlaces(symbols, block.positions);
    for (let q = 0; q < kAttributes; ++q) {
      if (block.hasAttribute[q]) this.readColumn(symbols, block.attribute(q), q);
    }
  }

  private readStrides(symbols: SymbolReader): void {
    const count = symbols.bits(2) + 1;
    if (count > 3) badBlock('it has more than three strides');
    this.strides.length = 0;
    this.strides.push(1);
    while (this.strides.length < count) {
      const stride = symbols.whole();
      if (stride === 0) badBlock('a stride is 0');
      this.strides.push(stride);
    }
  }

  private readPlaces(symbols: SymbolReader, positions: Uint16Array): void {
    const { places, sizes, strides } = this;
    for (let i = 0; i < this.count; ++i) {
      let known = 0;
      let x = 0;
      let y = 0;
      let z = 0;
      let sx = 0;
      let sy = 0;
      let sz = 0;
      for (const stride of strides) {
        if (i < stride) continue;
        ++known;
        const from = 3 * (places[i - stride] as number);
        x += positions[from] as number;
        y += positions[from + 1] as number;
        z += positions[from + 2] as number;
        const size = 3 * (i - stride);
        sx += sizes[size] as number;
        sy += sizes[size + 1] as number;
        sz += sizes[size + 2] as number;
      }
      if (known > 1) {
        sx = Math.floor(sx / known);
        sy = Math.floor(sy / known);
        sz = Math.floor(sz / known);
      }
      const all = sx + sy + sz;
      const to = 3 * (places[i] as number);
      this.readPlace(symbols, positions, to, 3 * i, 0, known, x, (13 * sx + all) >> 4);
      this.readPlace(symbols, positions, to, 3 * i, 1, known, y, (13 * sy + all) >> 4);
      this.readPlace(symbols, positions, to, 3 * i, 2, known, z, (13 * sz + all) >> 4);
    }
  }

  private readPlace(
    symbols: SymbolReader,
    positions: Uint16Array,
    to: number,
    at: number,
    q: number,
    known: number,
    sum: number,
    size: number,
  ): void {
    const value = this.readValue(symbols, known, sum, kMiddleOfGrid, size, q, at + q);
    if (value < 0 || value > 65535) badBlock('a position is outside the grid');
    positions[to + q] = value;
  }

  private readColumn(symbols: SymbolReader, column: Int32Array, attribute: number): void {
    const { places, sizes, strides } = this;
    for (let i = 0; i < this.count; ++i) {
      let known = 0;
      let sum = 0;
      let size = 0;
      for (const stride of strides) {
        if (i < stride) continue;
        ++known;
        sum += column[places[i - stride] as number] as number;
        size += sizes[3 * (i - stride)] as number;
      }
      if (known > 1) size = Math.floor(size / known);
      const value = this.readValue(symbols, known, sum, 0, size, attribute % 3, 3 * i);
      if (Math.abs(value) > kMostAttribute) badBlock('an attribute is too large');
      column[places[i] as number] = value;
    }
  }

  /** Reads a value, predicted by the mean of `known` earlier values with this sum. Stores its size. */
  private readValue(
    symbols: SymbolReader,
    known: number,
    sum: number,
    firstGuess: number,
    size: number,
    lane: number,
    at: number,
  ): number {
    let whole = firstGuess;
    let fraction = 0;
    let residualClass = kFirstClass;
    if (known > 0) {
      const middle = Math.floor((8 * sum) / known);
      whole = (middle + 4) >> 3;
      fraction = middle - 8 * whole;
      residualClass = Math.min(Math.max(classOfSize(size << 8), kLeastKeyClass), kClasses - 1);
    }
    const value = whole + symbols.residual(residualClass, fraction, lane);
    this.sizes[at] = Math.min(Math.abs(8 * (value - whole) - fraction), kMostSize);
    return value;
  }
}

function readGap(symbols: SymbolReader, order: number): number {
  let bits = order;
  while (bits < 32 && symbols.flag(2048)) ++bits;
  return symbols.longBits(bits) + 2 ** bits - 2 ** order;
}
