import { fitted } from './room.js';

/** The kind of a block's body, with the values of the format. */
export const BodyKind = { liquid: 0, deformable: 1, rigid: 2, vat: 3 } as const;
export type BodyKind = (typeof BodyKind)[keyof typeof BodyKind];

/** Speed, density, pressure, acceleration. */
export const kAttributes = 4;
const kNoAttributes: readonly boolean[] = [false, false, false, false];
/** The checksum covers three attributes in all frames, and acceleration if present. */
const kAlwaysChecked = 3;

/** The quantised data of one body. Reuses the memory of its columns. */
export class BlockData {
  body = 0;
  kind: BodyKind = BodyKind.liquid;
  count = 0;
  /** Whether `numbers` contains the particle numbers; otherwise they are 0, 1, 2, ... */
  isNumbered = false;
  numbers = new Uint32Array(0);
  positions = new Uint16Array(0);
  hasAttribute = kNoAttributes;
  readonly attributes = Array.from({ length: kAttributes }, () => new Int32Array(0));
  readonly place = new Int32Array(3);
  readonly orientation = new Int32Array(4);
  orientationBits = 0;

  get hasParticles(): boolean {
    return this.kind === BodyKind.liquid || this.kind === BodyKind.deformable;
  }

  number(i: number): number {
    return this.isNumbered ? this.numbers[i]! : i;
  }

  attribute(q: number): Int32Array<ArrayBuffer> {
    return this.attributes[q]!;
  }

  /** Sets the number of particles, and their numbers (0, 1, 2, ... if absent). */
  resize(count: number, numbers?: Uint32Array): void {
    this.count = count;
    this.positions = fitted(Uint16Array, this.positions, 3 * count);
    for (let q = 0; q < kAttributes; ++q) {
      const length = this.hasAttribute[q] ? count : 0;
      this.attributes[q] = fitted(Int32Array, this.attribute(q), length);
    }
    this.isNumbered = numbers !== undefined && count > 0 && numbers[count - 1] !== count - 1;
    this.numbers = fitted(Uint32Array, this.numbers, this.isNumbered ? count : 0);
    if (!numbers || !this.isNumbered) return;
    for (let i = 0; i < count; ++i) this.numbers[i] = numbers[i]!;
  }

  /** Sets the particles of `other`. */
  resizeLike(other: BlockData): void {
    this.resize(other.count, other.isNumbered ? other.numbers : undefined);
  }

  copy(other: BlockData): void {
    this.body = other.body;
    this.kind = other.kind;
    this.hasAttribute = other.hasAttribute;
    this.resizeLike(other);
    this.positions.set(other.positions);
    for (let q = 0; q < kAttributes; ++q) this.attribute(q).set(other.attribute(q));
    this.place.set(other.place);
    this.orientation.set(other.orientation);
    this.orientationBits = other.orientationBits;
  }

  /** Returns the checksum of protocol/FRAMES.md after this block, continued from `sum`. */
  addTo(sum: number): number {
    sum = mix(mix(sum, this.body), this.kind);
    if (!this.hasParticles) {
      sum = mix(sum, this.orientationBits);
      return mix(mix(sum, checkOf(this.place)), checkOf(this.orientation));
    }
    sum = mix(mix(sum, this.count), this.isNumbered ? checkOf(this.numbers) : 0);
    let x = 0;
    let y = 0;
    let z = 0;
    const { positions, count } = this;
    for (let k = 0; k < 3 * count; k += 3) {
      x = mix(x, positions[k]!);
      y = mix(y, positions[k + 1]!);
      z = mix(z, positions[k + 2]!);
    }
    sum = mix(mix(mix(sum, x), y), z);
    for (let q = 0; q < kAttributes; ++q) {
      if (q < kAlwaysChecked || this.hasAttribute[q]) sum = mix(sum, checkOf(this.attribute(q)));
    }
    return sum;
  }
}

function mix(sum: number, value: number): number {
  return (Math.imul(sum, 16777619) + value) | 0;
}

function checkOf(values: Int32Array | Uint32Array): number {
  let sum = 0;
  for (let i = 0; i < values.length; ++i) sum = mix(sum, values[i]!);
  return sum;
}
