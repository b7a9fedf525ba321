import { badBlock, FrameError } from './frame_error.js';
import { kCases, kClasses, kEscape, kRadius, kRanges, kResiduals } from './residual_tables.js';
import { kResidualBits, kSlotBits, kTableBits } from './residual_tables.js';
import { kGrowth } from './room.js';

export const kLeastState = 1 << 15;
const kMostResidualBits = 30;
const kTableMask = (1 << kTableBits) - 1;
const kSlotMask = (1 << kSlotBits) - 1;
const kResidualMask = (1 << kResidualBits) - 1;
/** The number of words that can be read before the end of the data is checked. */
const kReadAhead = 3;

/** The entropy decoder of protocol/FRAMES.md, "Symbols". */
export class SymbolReader {
  /** Index of the next word, and the words. Words from `wordCount` on are undefined. */
  next = 0;
  words = new Uint16Array(0);
  wordCount = 0;
  readonly states = new Int32Array(3);
  /** Bytes after the last complete word. */
  private oddBytes = 0;
  private most = 0;

  /** Starts reading at `offset`, which must be even. */
  start(buffer: ArrayBuffer, offset: number): void {
    const bytes = buffer.byteLength - offset;
    // Typed arrays are little-endian on all supported machines.
    const words = new Uint16Array(buffer, offset, bytes >> 1);
    this.wordCount = words.length;
    this.oddBytes = bytes & 1;
    this.most = 8 * bytes;
    const room = words.length + kReadAhead;
    if (this.words.length < room) this.words = new Uint16Array(Math.ceil(kGrowth * room));
    this.words.set(words);
    this.next = 0;
    for (let lane = 0; lane < 3; ++lane) {
      const low = this.word();
      this.states[lane] = low | (this.word() << 16);
    }
    for (const state of this.states)
      if (state < kLeastState) badBlock('its states are out of range');
  }

  /** Returns whether the input can contain `count` items of at least one bit. */
  mayHold(count: number): boolean {
    return count <= this.most;
  }

  /** Checks the state after the last symbol. */
  end(): void {
    const left = 2 * (this.wordCount - this.next) + this.oddBytes;
    if (left !== 0) {
      throw new FrameError('extra_bytes', `${left} bytes after the last symbol`);
    }
    for (const state of this.states) {
      if (state !== kLeastState) badBlock('its final states are wrong');
    }
  }

  bits(count: number, lane = 0): number {
    if (count === 0) return 0;
    const state = this.states[lane]!;
    const rest = 12 - count;
    this.fill(lane, ((state >> 12) << rest) | (state & ((1 << rest) - 1)));
    return (state & 4095) >> rest;
  }

  /** Reads a flag that is true with probability `chances` / 4096. */
  flag(chances: number): boolean {
    const state = this.states[0]!;
    const slot = state & 4095;
    const value = slot < chances;
    const frequency = value ? chances : 4096 - chances;
    this.fill(0, Math.imul(frequency, state >> 12) + slot - (value ? 0 : chances));
    return value;
  }

  /** Reads `count` bits, lowest first, without a limit of `count`. */
  longBits(count: number, lane = 0): number {
    let value = 0;
    for (let done = 0; done < count; done += 12) {
      value += this.bits(Math.min(count - done, 12), lane) * 2 ** done;
    }
    return value;
  }

  whole(lane = 0): number {
    const length = this.bits(6, lane);
    if (length === 0) return 0;
    if (length > 32) badBlock('a number has more than 32 bits');
    return this.longBits(length - 1, lane) + 2 ** (length - 1);
  }

  /** Reads a residual. `fraction` is the prediction minus its integer part [eighths]. */
  residual(residualClass: number, fraction: number, lane: number): number {
    const kind = kCases[(residualClass << 3) | (fraction + 4)]!;
    const table = kind & kTableMask;
    const state = this.states[lane]!;
    const slot = state & kSlotMask;
    let value = kResiduals[(table << kSlotBits) | slot]!;
    const range = kRanges[(table << kResidualBits) | (value & kResidualMask)]!;
    this.fill(lane, Math.imul(range >>> 16, state >> kSlotBits) + slot - (range & 0xffff));
    if (kind > kTableMask || value === kEscape) value = this.completed(kind, value, lane);
    return fraction < 0 ? -value : value;
  }

  /** Returns the residual for the table's `value`, after reading an escape and the low bits. */
  completed(kind: number, value: number, lane: number): number {
    if (this.next > this.wordCount) endsEarly();
    const lowBits = kind >> kTableBits;
    if (value === kEscape) value = this.escaped(kRadius[(kind & kTableMask) >> 1]!, lowBits, lane);
    return lowBits > 0 ? (value << lowBits) + this.bits(lowBits, lane) : value;
  }

  residualClass(): number {
    const index = this.bits(7);
    if (index >= kClasses) badBlock('its class is above 67');
    return index;
  }

  private escaped(radius: number, lowBits: number, lane: number): number {
    const isNegative = this.bits(1, lane) === 1;
    const beyond = this.whole(lane);
    if (beyond >= 2 ** (kMostResidualBits - lowBits)) badBlock('a residual is too large');
    return isNegative ? -(radius + 1 + beyond) : radius + 1 + beyond;
  }

  private fill(lane: number, state: number): void {
    this.states[lane] = state < kLeastState ? (state << 16) | this.word() : state;
  }

  private word(): number {
    const { words, next, wordCount } = this;
    if (next >= wordCount) endsEarly();
    this.next = next + 1;
    return words[next]!;
  }
}

export function endsEarly(): never {
  throw new FrameError('truncated', 'the frame ends in its symbols');
}
