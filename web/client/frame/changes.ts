import { AddedParticles, kMostAttribute } from './added.js';
import type { BlockData } from './block_data.js';
import { kAttributes } from './block_data.js';
import { CellOrder } from './cell_order.js';
import { badBlock } from './frame_error.js';
import { KeptParticles, kNone } from './kept_particles.js';
import type { Matched } from './kept_particles.js';
import { Motion } from './motion.js';
import { Neighbourhood } from './neighbourhood.js';
import { fitted } from './room.js';
import type { SymbolReader } from './symbols.js';

const kEven = 2048;
const kOnGrid = { lanes: [true, true, true], least: 0, span: 65535 };

export function readFactor(symbols: SymbolReader): number {
  return symbols.bits(11) - 1024;
}

function readChance(symbols: SymbolReader): number {
  const chance = symbols.bits(12);
  if (chance === 0) badBlock('its removals have the probability 0');
  return chance;
}

/** Reads the changes of particles: protocol/FRAMES.md, "Changed particles". Reuses its memory. */
export class ParticleChanges {
  readonly added = new AddedParticles();
  private readonly cells = new CellOrder();
  private readonly neighbours = new Neighbourhood();
  private readonly motion = new Motion();
  private readonly kept = new KeptParticles();
  /** As in Matched. */
  private secondPlaces = new Int32Array(0);
  private newPlaces = new Int32Array(0);
  private numbers = new Uint32Array(0);
  private readonly moved = Array.from({ length: kAttributes }, () => false);
  private readonly factors = [0, 0, 0];
  /** Which of the three attributes of a pass are read. */
  private readonly lanes = [false, false, false];

  constructor(private readonly symbols: SymbolReader) {}

  read(first: BlockData, second: BlockData | undefined, block: BlockData): void {
    const { symbols, moved, kept } = this;
    const removes = symbols.flag(kEven);
    const added = symbols.whole();
    if (!symbols.mayHold(added)) badBlock('it has too few bytes for its particles');
    const moves = symbols.flag(kEven);
    for (let q = 0; q < kAttributes; ++q) {
      moved[q] = block.hasAttribute[q] === true && symbols.flag(kEven);
    }
    if (removes || moves || moved.includes(true)) this.readOrder(first);
    this.keepAll(first.count);
    if (removes) this.readRemoved();
    this.added.reserve(added);
    this.added.readNumbers(symbols, this.added.numbers);
    if (removes || added > 0) this.mergeNumbers(first, block);
    else block.resizeLike(first);
    this.keepUnmoved(first, block, moves);
    if (second) this.match(first, second);
    const { cells, secondPlaces, newPlaces } = this;
    const matched: Matched = { first, second, cells, secondPlaces, newPlaces };
    kept.reserve(first.count);
    if (moves) this.readPositions(matched, block);
    for (let begin = 0; begin < kAttributes; begin += 3) this.readAttributes(matched, block, begin);
    this.added.read(symbols, block);
  }

  private keepAll(count: number): void {
    const places = fitted(Int32Array, this.newPlaces, count);
    for (let i = 0; i < count; ++i) places[i] = i;
    this.newPlaces = places;
  }

  private readOrder(first: BlockData): void {
    const shift = this.symbols.bits(4);
    if (!this.cells.sort(first.positions, first.count, shift)) badBlock('its cells are too small');
  }

  private readRemoved(): void {
    const { symbols, cells, newPlaces } = this;
    const afterKept = readChance(symbols);
    const afterGone = readChance(symbols);
    const count = cells.cellCount === 0 ? 0 : cells.begins[cells.cellCount + 1]!;
    let before = false;
    for (let k = 0; k < count; ++k) {
      before = symbols.flag(before ? afterGone : afterKept);
      if (before) newPlaces[cells.order[k]!] = kNone;
    }
  }

  /** Finds the indices of remaining and added particles by their numbers. */
  private mergeNumbers(first: BlockData, block: BlockData): void {
    const { newPlaces, added } = this;
    this.numbers = fitted(Uint32Array, this.numbers, first.count + added.count);
    const { numbers } = this;
    let place = 0;
    let next = 0;
    for (let i = 0; i < first.count; ++i) {
      if (newPlaces[i] === kNone) continue;
      const number = first.number(i);
      while (next < added.count && added.numbers[next]! < number) {
        added.places[next] = place;
        numbers[place++] = added.numbers[next++]!;
      }
      if (next < added.count && added.numbers[next] === number) {
        badBlock('a new particle exists already');
      }
      newPlaces[i] = place;
      numbers[place++] = number;
    }
    while (next < added.count) {
      added.places[next] = place;
      numbers[place++] = added.numbers[next++]!;
    }
    block.resize(place, numbers);
  }

  private keepUnmoved(first: BlockData, block: BlockData, moves: boolean): void {
    const { newPlaces, moved } = this;
    if (!moves) {
      for (let i = 0; i < first.count; ++i) {
        const place = newPlaces[i]!;
        if (place === kNone) continue;
        for (let q = 0; q < 3; ++q) block.positions[3 * place + q] = first.positions[3 * i + q]!;
      }
    }
    for (let q = 0; q < kAttributes; ++q) {
      if (!block.hasAttribute[q] || moved[q]) continue;
      const [from, to] = [first.attribute(q), block.attribute(q)];
      for (let i = 0; i < first.count; ++i) {
        const place = newPlaces[i]!;
        if (place !== kNone) to[place] = from[i]!;
      }
    }
  }

  private match(first: BlockData, second: BlockData): void {
    this.secondPlaces = fitted(Int32Array, this.secondPlaces, first.count);
    const { secondPlaces } = this;
    let j = 0;
    for (let i = 0; i < first.count; ++i) {
      const number = first.number(i);
      if (!second.isNumbered) j = Math.min(number, second.count);
      else while (j < second.count && second.numbers[j]! < number) ++j;
      secondPlaces[i] = j < second.count && second.number(j) === number ? j : kNone;
    }
  }

  private readPositions(matched: Matched, block: BlockData): void {
    const { symbols, cells, kept } = this;
    const common = readFactor(symbols);
    const own = readFactor(symbols);
    this.motion.predict(matched, kept, common, own);
    const { ends, values, targets } = kept;
    this.neighbours.read(symbols, cells, ends, values, kOnGrid);
    const { positions } = block;
    const count = cells.cellCount === 0 ? 0 : ends[cells.cellCount]!;
    for (let k = 0, at = 0; k < count; ++k, at += 3) {
      const to = 3 * targets[k]!;
      positions[to] = values[at]!;
      positions[to + 1] = values[at + 1]!;
      positions[to + 2] = values[at + 2]!;
    }
  }

  /** Reads up to three attributes, starting with `begin`, if they exist and have changed. */
  private readAttributes(matched: Matched, block: BlockData, begin: number): void {
    const { symbols, cells, kept, moved, lanes, factors } = this;
    for (let q = 0; q < 3; ++q) lanes[q] = moved[begin + q] === true;
    if (!lanes.includes(true)) return;
    for (let q = 0; q < 3; ++q) factors[q] = lanes[q] ? readFactor(symbols) : 0;
    const count = this.predictAttributes(matched, begin);
    const { ends, values, targets } = kept;
    const wanted = { lanes, least: -kMostAttribute, span: 2 * kMostAttribute };
    this.neighbours.read(symbols, cells, ends, values, wanted);
    for (let q = 0; q < 3; ++q) {
      if (!lanes[q]) continue;
      const column = block.attribute(begin + q);
      for (let k = 0; k < count; ++k) column[targets[k]!] = values[3 * k + q]!;
    }
  }

  /** Returns the number of particles. */
  private predictAttributes(matched: Matched, begin: number): number {
    const { ends, values, targets } = this.kept;
    const { second, secondPlaces, newPlaces } = matched;
    const { cellCount, begins, order } = this.cells;
    let count = 0;
    for (let c = 1; c <= cellCount; ++c) {
      for (let k = begins[c]!; k < begins[c + 1]!; ++k) {
        const i = order[k]!;
        const place = newPlaces[i]!;
        if (place === kNone) continue;
        const j = second ? secondPlaces[i]! : kNone;
        for (let q = 0; q < 3; ++q) {
          values[3 * count + q] = this.lanes[q] ? this.attributeAhead(matched, begin, q, i, j) : 0;
        }
        targets[count++] = place;
      }
      ends[c] = count;
    }
    return count;
  }

  private attributeAhead(
    { first, second }: Matched,
    begin: number,
    q: number,
    i: number,
    j: number,
  ): number {
    const here = first.attribute(begin + q)[i]!;
    const step = second && j !== kNone ? here - second.attribute(begin + q)[j]! : 0;
    return 8 * here + Math.floor((8 * this.factors[q]! * step + 128) / 256);
  }
}
