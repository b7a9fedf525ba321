import { AddedParticles, kMostAttribute } from './added';
import type { BlockData } from './block_data';
import { kAttributes } from './block_data';
import { CellOrder } from './cell_order';
import { kInverses, Neighbourhood } from './neighbourhood';
import { badBlock } from './symbols';
import type { SymbolReader } from './symbols';

const kNone = 0xffffffff;
const kEven = 2048;
const kMostStep = 8191;
const kMostCounted = 63;

export function readFactor(symbols: SymbolReader): number {
  return symbols.bits(11) - 1024;
}

/** What has changed of a body's particles: protocol/PROTOCOL.md, "Particles". Keeps its memory. */
export class ParticleChanges {
  readonly added = new AddedParticles();
  private readonly cells = new CellOrder();
  private readonly neighbours = new Neighbourhood();
  /** By particle of the first reference: its place in the second, and in the new block. */
  private secondPlaces = new Uint32Array(0);
  private newPlaces = new Uint32Array(0);
  /** By cell: sums of steps and their count; and the mean step around it [eighths]. */
  private stepSums = new Int32Array(0);
  private meanSteps = new Int32Array(0);
  private readonly moved: boolean[] = [false, false, false];
  private readonly predictions = new Int32Array(3);
  private readonly values = new Int32Array(3);
  private readonly factors = [0, 0, 0];

  read(
    symbols: SymbolReader,
    first: BlockData,
    second: BlockData | undefined,
    block: BlockData,
  ): void {
    this.reserve(first.count);
    const removes = symbols.flag(kEven);
    const added = symbols.whole();
    if (!symbols.mayHold(added)) badBlock('it has too few bytes for its particles');
    const moves = symbols.flag(kEven);
    const { moved } = this;
    for (let q = 0; q < kAttributes; ++q) {
      moved[q] = block.hasAttribute[q] === true && symbols.flag(kEven);
    }
    if (removes || moves || moved.includes(true)) this.readOrder(symbols, first);
    for (let i = 0; i < first.count; ++i) this.newPlaces[i] = i;
    if (removes) this.readRemoved(symbols);
    this.added.reserve(added);
    this.added.readNumbers(symbols, this.added.numbers);
    this.mergeNumbers(first, block);
    this.keepUnmoved(first, block, moves);
    if (second) this.match(first, second);
    if (moves) this.readPositions(symbols, first, second, block);
    if (moved.includes(true)) this.readAttributes(symbols, first, second, block);
    this.added.read(symbols, block);
  }

  private reserve(count: number): void {
    if (this.newPlaces.length >= count) return;
    const room = Math.ceil(1.5 * count);
    this.newPlaces = new Uint32Array(room);
    this.secondPlaces = new Uint32Array(room);
    this.stepSums = new Int32Array(4 * (room + 1));
    this.meanSteps = new Int32Array(3 * (room + 1));
  }

  private readOrder(symbols: SymbolReader, first: BlockData): void {
    const shift = symbols.bits(4);
    if (!this.cells.sort(first.positions, first.count, shift)) badBlock('its cells are too small');
  }

  private readRemoved(symbols: SymbolReader): void {
    const chances = [symbols.bits(12), symbols.bits(12)];
    if (chances.includes(0)) badBlock('nothing has a chance to go');
    const { cells, newPlaces } = this;
    const [afterKept = 0, afterGone = 0] = chances;
    let before = false;
    const count = cells.cellCount === 0 ? 0 : (cells.begins[cells.cellCount + 1] as number);
    for (let k = 0; k < count; ++k) {
      before = symbols.flag(before ? afterGone : afterKept);
      if (before) newPlaces[cells.order[k] as number] = kNone;
    }
  }

  /** Finds the places of those that stay and of those that come, by their numbers. */
  private mergeNumbers(first: BlockData, block: BlockData): void {
    const { newPlaces, added } = this;
    let place = 0;
    let next = 0;
    block.resizeNumbers(first.count + added.count);
    const { numbers } = block;
    for (let i = 0; i < first.count; ++i) {
      if (newPlaces[i] === kNone) continue;
      const number = first.number(i);
      while (next < added.count && (added.numbers[next] as number) < number) {
        added.places[next] = place;
        numbers[place++] = added.numbers[next++] as number;
      }
      if (next < added.count && added.numbers[next] === number) {
        badBlock('what comes is there already');
      }
      newPlaces[i] = place;
      numbers[place++] = number;
    }
    while (next < added.count) {
      added.places[next] = place;
      numbers[place++] = added.numbers[next++] as number;
    }
    block.resize(place);
    block.isNumbered = place > 0 && numbers[place - 1] !== place - 1;
  }

  private keepUnmoved(first: BlockData, block: BlockData, moves: boolean): void {
    const { newPlaces, moved } = this;
    for (let i = 0; i < first.count; ++i) {
      const place = newPlaces[i] as number;
      if (place === kNone) continue;
      if (!moves) {
        for (let q = 0; q < 3; ++q) {
          block.positions[3 * place + q] = first.positions[3 * i + q] as number;
        }
      }
      for (let q = 0; q < kAttributes; ++q) {
        if (!block.hasAttribute[q] || moved[q]) continue;
        block.attribute(q)[place] = first.attribute(q)[i] as number;
      }
    }
  }

  private match(first: BlockData, second: BlockData): void {
    let j = 0;
    for (let i = 0; i < first.count; ++i) {
      const number = first.number(i);
      if (!second.isNumbered) j = Math.min(number, second.count);
      else while (j < second.count && (second.numbers[j] as number) < number) ++j;
      this.secondPlaces[i] = j < second.count && second.number(j) === number ? j : kNone;
    }
  }

  private findMeanSteps(first: BlockData, second: BlockData | undefined): void {
    const { cells, stepSums, meanSteps } = this;
    const count = cells.cellCount;
    meanSteps.fill(0, 0, 3 * (count + 1));
    if (!second) return;
    stepSums.fill(0, 0, 4 * (count + 1));
    for (let c = 1; c <= count; ++c) this.sumSteps(c, first.positions, second.positions);
    const { row, layer, numbers } = cells;
    for (let c = 1; c <= count; ++c) {
      const corner = (cells.places[c] as number) - layer - row - 1;
      let x = 0;
      let y = 0;
      let z = 0;
      let n = 0;
      for (let up = 0; up < 3; ++up) {
        for (let along = 0; along < 3; ++along) {
          const line = corner + up * layer + along * row;
          for (let place = line; place < line + 3; ++place) {
            const at = 4 * (numbers[place] as number);
            x += stepSums[at] as number;
            y += stepSums[at + 1] as number;
            z += stepSums[at + 2] as number;
            n += stepSums[at + 3] as number;
          }
        }
      }
      const inverse = kInverses[n] as number;
      meanSteps[3 * c] = (x * inverse) >> 13;
      meanSteps[3 * c + 1] = (y * inverse) >> 13;
      meanSteps[3 * c + 2] = (z * inverse) >> 13;
    }
  }

  private sumSteps(cell: number, first: Uint16Array, second: Uint16Array): void {
    const { begins, order } = this.cells;
    const begin = begins[cell] as number;
    const end = Math.min(begins[cell + 1] as number, begin + kMostCounted);
    let x = 0;
    let y = 0;
    let z = 0;
    let n = 0;
    for (let k = begin; k < end; ++k) {
      const i = order[k] as number;
      const j = this.secondPlaces[i] as number;
      if (j === kNone) continue;
      x += bounded((first[3 * i] as number) - (second[3 * j] as number));
      y += bounded((first[3 * i + 1] as number) - (second[3 * j + 1] as number));
      z += bounded((first[3 * i + 2] as number) - (second[3 * j + 2] as number));
      ++n;
    }
    const at = 4 * cell;
    this.stepSums[at] = x;
    this.stepSums[at + 1] = y;
    this.stepSums[at + 2] = z;
    this.stepSums[at + 3] = n;
  }

  private readPositions(
    symbols: SymbolReader,
    first: BlockData,
    second: BlockData | undefined,
    block: BlockData,
  ): void {
    this.findMeanSteps(first, second);
    const common = readFactor(symbols);
    const own = readFactor(symbols);
    this.readTuning(symbols);
    const { cells, neighbours, newPlaces, secondPlaces, meanSteps, predictions, values } = this;
    const { order, begins, cellCount } = cells;
    const { wholes, fractions, classes } = neighbours;
    const before = first.positions;
    const now = block.positions;
    for (let c = 1; c <= cellCount; ++c) {
      neighbours.enter(cells, cells.places[c] as number);
      const end = begins[c + 1] as number;
      for (let k = begins[c] as number; k < end; ++k) {
        const i = order[k] as number;
        const place = newPlaces[i] as number;
        if (place === kNone) continue;
        const j = second ? (secondPlaces[i] as number) : kNone;
        for (let q = 0; q < 3; ++q) {
          const here = before[3 * i + q] as number;
          const mean = meanSteps[3 * c + q] as number;
          const beyond =
            second && j !== kNone ? 8 * (here - (second.positions[3 * j + q] as number)) - mean : 0;
          predictions[q] = 8 * here + ((common * mean + own * beyond + 128) >> 8);
        }
        neighbours.expect(predictions);
        for (let q = 0; q < 3; ++q) {
          values[q] =
            (wholes[q] as number) +
            symbols.residual(classes[q] as number, fractions[q] as number, q);
        }
        const x = values[0] as number;
        const y = values[1] as number;
        const z = values[2] as number;
        if (((x | y | z) & ~0xffff) !== 0) badBlock('a position is outside the grid');
        now[3 * place] = x;
        now[3 * place + 1] = y;
        now[3 * place + 2] = z;
        neighbours.learn(predictions, values);
      }
      neighbours.leave(c);
    }
  }

  private readAttributes(
    symbols: SymbolReader,
    first: BlockData,
    second: BlockData | undefined,
    block: BlockData,
  ): void {
    const { cells, neighbours, newPlaces, secondPlaces, moved, predictions, values, factors } =
      this;
    for (let q = 0; q < kAttributes; ++q) factors[q] = moved[q] ? readFactor(symbols) : 0;
    this.readTuning(symbols);
    const { wholes, fractions, classes } = neighbours;
    for (let c = 1; c <= cells.cellCount; ++c) {
      neighbours.enter(cells, cells.places[c] as number);
      for (let k = cells.begins[c] as number; k < (cells.begins[c + 1] as number); ++k) {
        const i = cells.order[k] as number;
        const place = newPlaces[i] as number;
        if (place === kNone) continue;
        const j = second ? (secondPlaces[i] as number) : kNone;
        for (let q = 0; q < kAttributes; ++q) {
          predictions[q] = 0;
          if (!moved[q]) continue;
          const here = first.attribute(q)[i] as number;
          const step = second && j !== kNone ? here - (second.attribute(q)[j] as number) : 0;
          predictions[q] = 8 * here + Math.floor((8 * (factors[q] ?? 0) * step + 128) / 256);
        }
        neighbours.expect(predictions);
        for (let q = 0; q < kAttributes; ++q) {
          values[q] = wholes[q] as number;
          if (!moved[q]) continue;
          values[q] =
            (wholes[q] as number) +
            symbols.residual(classes[q] as number, fractions[q] as number, q);
        }
        for (let q = 0; q < kAttributes; ++q) {
          if (!moved[q]) continue;
          const value = values[q] as number;
          if (Math.abs(value) > kMostAttribute) badBlock('an attribute is too large');
          block.attribute(q)[place] = value;
        }
        neighbours.learn(predictions, values);
      }
      neighbours.leave(c);
    }
  }

  private readTuning(symbols: SymbolReader): void {
    const shift = symbols.bits(3) - 4;
    this.neighbours.start(this.cells.cellCount, shift, symbols.residualClass());
  }
}

function bounded(step: number): number {
  return step > kMostStep ? kMostStep : step < -kMostStep ? -kMostStep : step;
}
