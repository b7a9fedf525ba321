import { Float32BufferAttribute, InstancedBufferAttribute, InstancedBufferGeometry } from 'three';
import type { FrameHeader, GridBlock } from '../../../client/index';

const kGrowth = 1.5;

/** Corners and triangles of the square of a particle. */
export const kSquare = [-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0];
export const kSquareTriangles = [0, 1, 2, 0, 2, 3];

/** The columns of several bodies; see ParticleColumns. */
export interface CopiedColumns {
  center: Uint16Array;
  before: Uint16Array;
  number: Uint32Array;
  value: Int32Array;
}

/** The grid of a frame. */
type Grid = Pick<FrameHeader, 'origin' | 'quantum'>;

/**
 * The graphics columns of a body's particles: positions of the newest frame (`center`) and of the
 * previous frame (`before`), numbers, and one value per particle.
 */
export class ParticleColumns {
  /** One square per particle. */
  readonly geometry: InstancedBufferGeometry;
  private readonly geometries: InstancedBufferGeometry[] = [];
  private places: [Places, Places];
  private newest = 0;
  private numbers: Uint32Array | undefined;
  private numberColumn: InstancedBufferAttribute;
  private valueColumn: InstancedBufferAttribute;
  private grid: Grid | undefined;
  private changes = 0;

  constructor(particles: number, local?: readonly number[]) {
    if (local) {
      const fixed = new Places(new Float32Array(local));
      this.places = [fixed, fixed];
    } else {
      this.places = [newPlaces(particles), newPlaces(particles)];
    }
    this.numberColumn = plainNumbers(particles);
    this.valueColumn = new InstancedBufferAttribute(new Int32Array(particles), 1);
    this.geometry = this.shapedAs(kSquare, kSquareTriangles);
    this.count = particles;
  }

  /** Returns instances of a shape with these corners and triangles. */
  shapedAs(corners: number[], triangles: number[]): InstancedBufferGeometry {
    const geometry = new InstancedBufferGeometry();
    geometry.setAttribute('position', new Float32BufferAttribute(corners, 3));
    geometry.setIndex(triangles);
    geometry.instanceCount = this.geometries[0]?.instanceCount ?? 0;
    this.geometries.push(geometry);
    this.attach();
    return geometry;
  }

  dispose(): void {
    for (const geometry of this.geometries) geometry.dispose();
  }

  /** Increases with each change of the columns. */
  get version(): number {
    return this.changes;
  }

  /** Copies the columns to those of several bodies, from particle `at` on. */
  copyTo(to: CopiedColumns, at: number): void {
    const { count } = this;
    to.center.set(this.places[this.newest]!.array.subarray(0, 3 * count), 3 * at);
    to.before.set(this.places[1 - this.newest]!.array.subarray(0, 3 * count), 3 * at);
    to.number.set((this.numberColumn.array as Uint32Array).subarray(0, count), at);
    to.value.set((this.valueColumn.array as Int32Array).subarray(0, count), at);
  }

  /** The present number of particles, which can change for a liquid. */
  get count(): number {
    return this.geometry.instanceCount;
  }

  private set count(count: number) {
    for (const geometry of this.geometries) geometry.instanceCount = count;
  }

  /**
   * Shows the positions of a block. If the number of particles is unchanged, they are not copied:
   * positions and numbers must not change until the second next call.
   */
  show(block: GridBlock, grid: Grid): void {
    const count = block.positions.length / 3;
    if (count > this.room) this.grow(count);
    const old = this.places[this.newest]!;
    const follows = this.follows(block.numbers, count, grid);
    const before = follows || !this.grid ? undefined : this.carriedOver(block, old.array, grid);
    this.newest = 1 - this.newest;
    this.places[this.newest]!.set(block.positions);
    if (!follows) old.set(before ?? block.positions);
    const wasNumbered = this.numbers !== undefined;
    this.numbers = block.numbers;
    this.count = count;
    if (wasNumbered || this.numbers) this.showNumbers();
    this.grid = { origin: [...grid.origin], quantum: grid.quantum };
    ++this.changes;
    this.attach();
  }

  /** Ends the interpolation with the current frame. */
  rest(): void {
    this.grid = undefined;
  }

  /** Shows values for the particles of the last block. */
  showValues(values: Int32Array): void {
    (this.valueColumn.array as Int32Array).set(values);
    this.valueColumn.needsUpdate = true;
    ++this.changes;
  }

  /** Returns the index of a particle number; undefined if it is not shown. */
  placeOf(particle: number): number | undefined {
    const place = this.numbers ? placeIn(this.numbers, particle) : particle;
    return place !== undefined && place < this.count ? place : undefined;
  }

  /** Returns the particle number at an index. */
  numberAt(place: number): number {
    return this.numbers?.[place] ?? place;
  }

  /** Returns the coordinates of all particles, in units of the columns, at a phase from 0 to 1. */
  coordinates(phase: number): ArrayLike<number> {
    const newest = this.places[this.newest]!.array.subarray(0, 3 * this.count);
    const before = this.places[1 - this.newest]!.array;
    if (phase === 1 || before === newest) return newest;
    const mixed = new Float32Array(newest.length);
    for (let i = 0; i < mixed.length; ++i) {
      mixed[i] = before[i]! + phase * (newest[i]! - before[i]!);
    }
    return mixed;
  }

  /** Returns a copy of the newest coordinates. */
  newestPlaces(): Uint16Array | Float32Array {
    return this.places[this.newest]!.array.slice(0, 3 * this.count);
  }

  /** Returns coordinate `i` of coordinates(). */
  coordinate(i: number, phase: number): number {
    const newest = this.places[this.newest]!.array[i]!;
    const before = this.places[1 - this.newest]!.array[i]!;
    return before + phase * (newest - before);
  }

  private get room(): number {
    return this.numberColumn.count;
  }

  /** Returns whether the previous frame has the same particles and grid. */
  private follows(numbers: Uint32Array | undefined, count: number, grid: Grid): boolean {
    if (!this.grid || count !== this.count || !isSameGrid(this.grid, grid)) return false;
    if (!numbers || !this.numbers) return numbers === this.numbers;
    return numbers.every((number, i) => number === this.numbers![i]);
  }

  /** Returns the previous positions on the new grid. New particles keep their positions. */
  private carriedOver(block: GridBlock, old: Column, grid: Grid): Uint16Array {
    const carried = block.positions.slice();
    const from = this.grid!;
    const scale = from.quantum / grid.quantum;
    const shift = from.origin.map((origin, q) => (origin - grid.origin[q]!) / grid.quantum);
    let place = 0; // both lists of numbers ascend
    for (let i = 0; 3 * i < carried.length; ++i) {
      const number = block.numbers ? block.numbers[i]! : i;
      while (place < this.count && this.numberAt(place) < number) ++place;
      if (place >= this.count || this.numberAt(place) !== number) continue;
      for (let q = 0; q < 3; ++q) {
        const moved = scale * old[3 * place + q]! + shift[q]!;
        carried[3 * i + q] = Math.min(Math.max(Math.round(moved), 0), 65535);
      }
    }
    return carried;
  }

  /** Replaces the buffers by larger ones with reserve, because graphics buffers have a fixed length. */
  private grow(count: number): void {
    const room = Math.ceil(kGrowth * count);
    this.dispose(); // releases the old buffers
    const old = this.places[this.newest]!.array;
    this.places = [newPlaces(room), newPlaces(room)];
    this.places[this.newest]!.set(old as Uint16Array);
    this.numberColumn = plainNumbers(room);
    this.valueColumn = new InstancedBufferAttribute(new Int32Array(room), 1);
  }

  private attach(): void {
    for (const geometry of this.geometries) {
      geometry.setAttribute('center', this.places[this.newest]!.attribute);
      geometry.setAttribute('before', this.places[1 - this.newest]!.attribute);
      geometry.setAttribute('number', this.numberColumn);
      geometry.setAttribute('value', this.valueColumn);
    }
  }

  /** Uploads the numbers if they have changed. */
  private showNumbers(): void {
    const { numbers, count } = this;
    const shown = this.numberColumn.array as Uint32Array;
    for (let i = 0; i < count; ++i) {
      const number = numbers ? numbers[i]! : i;
      if (shown[i] === number) continue;
      shown[i] = number;
      this.numberColumn.needsUpdate = true;
    }
  }
}

type Column = Uint16Array | Float32Array;

/** A column of coordinates with a graphics buffer of fixed length. */
class Places {
  readonly attribute: InstancedBufferAttribute;
  private readonly room: number;
  /** A copy for positions that do not fill the buffer. */
  private copies: Uint16Array | undefined;

  constructor(array: Column) {
    this.room = array.length;
    this.attribute = new InstancedBufferAttribute(array, 3);
  }

  get array(): Column {
    return this.attribute.array as Column;
  }

  set(positions: Uint16Array): void {
    if (positions.length === this.room) this.attribute.array = positions;
    else {
      this.copies ??= new Uint16Array(this.room);
      this.copies.set(positions);
      this.attribute.array = this.copies;
    }
    this.attribute.needsUpdate = true;
  }
}

function newPlaces(particles: number): Places {
  return new Places(new Uint16Array(3 * particles));
}

/** Returns the numbers 0, 1, 2, ... */
function plainNumbers(count: number): InstancedBufferAttribute {
  return new InstancedBufferAttribute(
    new Uint32Array(count).map((_, i) => i),
    1,
  );
}

function isSameGrid(a: Grid, b: Grid): boolean {
  return a.quantum === b.quantum && a.origin.every((origin, q) => origin === b.origin[q]);
}

/** Returns the index of a value in ascending values. */
function placeIn(values: Uint32Array, value: number): number | undefined {
  let low = 0;
  let high = values.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((values[middle] as number) < value) low = middle + 1;
    else high = middle;
  }
  return values[low] === value ? low : undefined;
}
