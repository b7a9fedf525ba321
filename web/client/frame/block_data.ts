/** What a block is about; the values are those on the wire. */
export const BodyKind = { liquid: 0, deformable: 1, rigid: 2, vat: 3 } as const;
export type BodyKind = (typeof BodyKind)[keyof typeof BodyKind];

export const kAttributes = 3;

/** A body's part of a frame in whole steps. Its arrays keep their room; `count` is what counts. */
export class BlockData {
  body = 0;
  kind: BodyKind = BodyKind.liquid;
  count = 0;
  /** Whether `numbers` has the particles' numbers; otherwise they are 0, 1, 2, ... */
  isNumbered = false;
  numbers = new Uint32Array(0);
  positions = new Uint16Array(0);
  hasAttribute: boolean[] = [false, false, false];
  attributes = [new Int32Array(0), new Int32Array(0), new Int32Array(0)];
  place = new Int32Array(3);
  orientation = new Int32Array(4);
  orientationBits = 0;

  get hasParticles(): boolean {
    return this.kind === BodyKind.liquid || this.kind === BodyKind.deformable;
  }

  number(i: number): number {
    return this.isNumbered ? (this.numbers[i] as number) : i;
  }

  attribute(q: number): Int32Array {
    return this.attributes[q] as Int32Array;
  }

  /** Room for so many particles; what was there before is lost where it grows. */
  resize(count: number): void {
    this.count = count;
    const room = Math.ceil(1.5 * count);
    if (this.positions.length < 3 * count) this.positions = new Uint16Array(3 * room);
    for (let q = 0; q < kAttributes; ++q) {
      if (!this.hasAttribute[q] || this.attribute(q).length >= count) continue;
      this.attributes[q] = new Int32Array(room);
    }
  }

  resizeNumbers(count: number): void {
    if (this.numbers.length < count) this.numbers = new Uint32Array(Math.ceil(1.5 * count));
  }

  copy(other: BlockData): void {
    this.body = other.body;
    this.kind = other.kind;
    this.hasAttribute = other.hasAttribute;
    this.isNumbered = other.isNumbered;
    this.resize(other.count);
    this.positions.set(other.positions.subarray(0, 3 * other.count));
    if (other.isNumbered) {
      this.resizeNumbers(other.count);
      this.numbers.set(other.numbers.subarray(0, other.count));
    }
    for (let q = 0; q < kAttributes; ++q) {
      if (!this.hasAttribute[q]) continue;
      this.attribute(q).set(other.attribute(q).subarray(0, other.count));
    }
    this.place.set(other.place);
    this.orientation.set(other.orientation);
    this.orientationBits = other.orientationBits;
  }

  /** The check of protocol/PROTOCOL.md goes on from `sum` with this block. */
  addTo(sum: number): number {
    sum = mix(mix(sum, this.body), this.kind);
    if (!this.hasParticles) {
      sum = mix(sum, this.orientationBits);
      return mix(mix(sum, checkOf(this.place, 3)), checkOf(this.orientation, 4));
    }
    sum = mix(mix(sum, this.count), this.isNumbered ? checkOf(this.numbers, this.count) : 0);
    let x = 0;
    let y = 0;
    let z = 0;
    const { positions } = this;
    for (let k = 0; k < 3 * this.count; k += 3) {
      x = mix(x, positions[k] as number);
      y = mix(y, positions[k + 1] as number);
      z = mix(z, positions[k + 2] as number);
    }
    sum = mix(mix(mix(sum, x), y), z);
    for (let q = 0; q < kAttributes; ++q) {
      sum = mix(sum, this.hasAttribute[q] ? checkOf(this.attribute(q), this.count) : 0);
    }
    return sum;
  }
}

function mix(sum: number, value: number): number {
  return (Math.imul(sum, 16777619) + value) | 0;
}

function checkOf(values: Int32Array | Uint32Array, count: number): number {
  let sum = 0;
  for (let i = 0; i < count; ++i) sum = mix(sum, values[i] as number);
  return sum;
}
