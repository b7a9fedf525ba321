import { kClasses, kRadius, kStarts, kSymbols, kSymbolStarts, kTables } from './residual_tables';
import { FrameError } from './frame_error';

const kLeastState = 1 << 15;
const kMostResidualBits = 30;

/** The entropy decoder of protocol/PROTOCOL.md, "Symbols". */
export class SymbolReader {
  private bytes: Uint8Array = new Uint8Array(0);
  private next = 0;
  private most = 0;
  private readonly states = new Int32Array(3);

  /** The symbols begin at `offset`. */
  start(bytes: Uint8Array, offset: number): void {
    this.bytes = bytes;
    this.next = offset;
    this.most = 8 * (bytes.length - offset);
    for (let lane = 0; lane < 3; ++lane) {
      const low = this.word();
      this.states[lane] = low | (this.word() << 16);
    }
    for (const state of this.states) if (state < kLeastState) badBlock('its states are none');
  }

  /** Whether there can be so many things that take a bit or more each. */
  mayHold(count: number): boolean {
    return count <= this.most;
  }

  /** All symbols have been read. */
  end(): void {
    if (this.next !== this.bytes.length) {
      const left = this.bytes.length - this.next;
      throw new FrameError('extra_bytes', `${left} bytes after the last symbol`);
    }
    for (const state of this.states) {
      if (state !== kLeastState) badBlock('its symbols end where no encoder began');
    }
  }

  bits(count: number, lane = 0): number {
    if (count === 0) return 0;
    const value = ((this.states[lane] ?? 0) & 4095) >> (12 - count);
    this.take(lane, value << (12 - count), 4096 >> count);
    return value;
  }

  /** True in `chances` of 4096 cases. */
  flag(chances: number): boolean {
    const value = ((this.states[0] ?? 0) & 4095) < chances;
    if (value) this.take(0, 0, chances);
    else this.take(0, chances, 4096 - chances);
    return value;
  }

  /** The lowest `count` bits of a number, however many. */
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

  /** What a prediction left; it was `fraction` eighths above its whole part. */
  residual(residualClass: number, fraction: number, lane: number): number {
    let table = residualClass;
    let lowBits = 0;
    if (residualClass >= kTables) {
      table = kTables - 4 + ((residualClass - kTables) & 3);
      lowBits = 1 + ((residualClass - kTables) >> 2);
    }
    const index = 2 * table + (fraction >= 2 || fraction <= -2 ? 1 : 0);
    const state = this.states[lane] as number;
    const slot = state & 4095;
    const symbol = kSymbols[(index << 12) | slot] as number;
    const at = index * kStarts + symbol;
    const start = kSymbolStarts[at] as number;
    const frequency = (kSymbolStarts[at + 1] as number) - start;
    const after = frequency * (state >> 12) + slot - start;
    this.states[lane] = after < kLeastState ? (after << 16) | this.word() : after;
    const radius = kRadius[table] as number;
    let value = symbol - radius;
    if (value > radius) value = this.escaped(radius, lowBits, lane);
    if (lowBits > 0) value = (value << lowBits) + this.bits(lowBits, lane);
    return fraction < 0 ? -value : value;
  }

  residualClass(): number {
    const index = this.bits(7);
    if (index >= kClasses) badBlock('it has a class that there is not');
    return index;
  }

  private escaped(radius: number, lowBits: number, lane: number): number {
    const isNegative = this.bits(1, lane) === 1;
    const beyond = this.whole(lane);
    if (beyond >= 2 ** (kMostResidualBits - lowBits)) badBlock('a residual is too large');
    return isNegative ? -(radius + 1 + beyond) : radius + 1 + beyond;
  }

  private take(lane: number, start: number, frequency: number): void {
    const state = this.states[lane] as number;
    const after = frequency * (state >> 12) + (state & 4095) - start;
    this.states[lane] = after < kLeastState ? (after << 16) | this.word() : after;
  }

  private word(): number {
    const at = this.next;
    if (at + 2 > this.bytes.length) {
      throw new FrameError('truncated', 'the frame ends early: in its symbols');
    }
    this.next = at + 2;
    return (this.bytes[at] as number) | ((this.bytes[at + 1] as number) << 8);
  }
}

export function badBlock(reason: string): never {
  throw new FrameError('bad_block', `a block is wrong: ${reason}`);
}
