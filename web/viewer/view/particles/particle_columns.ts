import { BufferGeometry } from 'three';
import type { Vector4 } from 'three';
import type { FrameHeader, GridBlock } from '../../../client/index';
import { kSquareVertices } from './impostor';
import { Texels, kNoValues, particleUniforms, texelsAt } from './texels';

const kGrowth = 1.5;

/** The textures of several bodies; see ParticleColumns. */
export interface CopiedColumns {
  center: Texels<Uint16Array>;
  before: Texels<Uint16Array>;
  names: Texels<Uint32Array>;
  shown: Texels<Int32Array>;
}

/** The grid of a frame. */
type Grid = Pick<FrameHeader, 'origin' | 'quantum'>;

/**
 * The graphics columns of a body's particles: positions of the newest frame (`center`) and of the
 * previous frame (`before`), numbers, and one value per particle.
 */
export class ParticleColumns {
  /** One square per particle. */
  readonly geometry: BufferGeometry;
  readonly uniforms = particleUniforms();
  private readonly geometries: { geometry: BufferGeometry; vertices: number }[] = [];
  private places: [Places, Places];
  private newest = 0;
  private numbers: Uint32Array | undefined;
  private names: Texels<Uint32Array>;
  private shown: Texels<Int32Array> | undefined;
  private particles: number;
  private grid: Grid | undefined;
  private changes = 0;
  private changesOfNames = 0;

  constructor(particles: number, local?: readonly number[]) {
    if (local) {
      const fixed = new FixedPlaces(local, this.uniforms.texel_grid.value);
      this.places = [fixed, fixed];
    } else {
      this.places = [new MovingPlaces(particles), new MovingPlaces(particles)];
    }
    this.names = plainNames(particles);
    this.particles = particles;
    this.geometry = this.shapedAs(kSquareVertices);
    this.attach();
  }

  /** Returns a geometry with this number of vertices for each particle. */
  shapedAs(vertices: number): BufferGeometry {
    const geometry = new BufferGeometry();
    geometry.setDrawRange(0, vertices * this.particles);
    this.geometries.push({ geometry, vertices });
    return geometry;
  }

  dispose(): void {
    for (const { geometry } of this.geometries) geometry.dispose();
    this.disposeTexels();
  }

  /** Increases with each change of the columns. */
  get version(): number {
    return this.changes;
  }

  /** Increases with each change of the particle numbers. */
  get versionOfNames(): number {
    return this.changesOfNames;
  }

  /** Copies positions and values to those of several bodies, from particle `at` on. */
  copyTo(to: CopiedColumns, at: number): void {
    const { count } = this;
    to.center.set(this.places[this.newest]!.texels.values.subarray(0, 3 * count), at);
    to.before.set(this.places[1 - this.newest]!.texels.values.subarray(0, 3 * count), at);
    if (this.shown) to.shown.set(this.shown.values.subarray(0, count), at);
  }

  /** Writes the particle numbers and a row to those of several bodies, from particle `at` on. */
  copyNamesTo(names: Texels<Uint32Array>, at: number, row: number): void {
    const { values } = names;
    for (let i = 0; i < this.particles; ++i) {
      values[2 * (at + i)] = this.numberAt(i);
      values[2 * (at + i) + 1] = row;
    }
    names.changed();
  }

  /** The present number of particles, which can change for a liquid. */
  get count(): number {
    return this.particles;
  }

  private set count(count: number) {
    if (count !== this.particles) ++this.changesOfNames;
    this.particles = count;
    for (const { geometry, vertices } of this.geometries)
      geometry.setDrawRange(0, vertices * count);
  }

  /** Shows the positions of a block. Its numbers must not change until the second next call. */
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
    this.shown ??= Texels.shown(this.names.room);
    this.shown.set(values);
    this.attach();
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
    return this.names.room;
  }

  /** Returns whether the previous frame has the same particles and grid. */
  private follows(numbers: Uint32Array | undefined, count: number, grid: Grid): boolean {
    if (!this.grid || count !== this.count || !isSameGrid(this.grid, grid)) return false;
    if (!numbers || !this.numbers) return numbers === this.numbers;
    return numbers.every((number, i) => number === this.numbers![i]);
  }

  /** Returns the previous positions on the new grid. New particles keep their positions. */
  private carriedOver(block: GridBlock, old: Places['array'], grid: Grid): Uint16Array {
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

  /** Replaces the textures by larger ones with reserve, because they have a fixed size. */
  private grow(count: number): void {
    const room = Math.ceil(kGrowth * count);
    const old = this.places[this.newest]!.array;
    this.disposeTexels();
    this.places = [new MovingPlaces(room), new MovingPlaces(room)];
    this.places[this.newest]!.set(old as Uint16Array);
    this.names = plainNames(room);
    this.shown = undefined;
  }

  private disposeTexels(): void {
    for (const { texels } of this.places) texels.dispose();
    this.names.dispose();
    this.shown?.dispose();
  }

  private attach(): void {
    const { uniforms } = this;
    uniforms.center_texels.value = this.places[this.newest]!.texels.texture;
    uniforms.before_texels.value = this.places[1 - this.newest]!.texels.texture;
    uniforms.name_texels.value = this.names.texture;
    uniforms.value_texels.value = this.shown?.texture ?? kNoValues;
  }

  /** Uploads the numbers if they have changed. */
  private showNumbers(): void {
    const { numbers, count, names } = this;
    let isChanged = false;
    for (let i = 0; i < count; ++i) {
      const number = numbers ? numbers[i]! : i;
      if (names.values[2 * i] === number) continue;
      names.values[2 * i] = number;
      isChanged = true;
    }
    if (!isChanged) return;
    names.changed();
    ++this.changesOfNames;
  }
}

/** A column of coordinates, and its texture. */
interface Places {
  readonly array: Uint16Array | Float32Array;
  readonly texels: Texels<Uint16Array>;
  set(positions: Uint16Array): void;
}

class MovingPlaces implements Places {
  readonly texels: Texels<Uint16Array>;

  constructor(particles: number) {
    this.texels = Texels.places(particles);
  }

  get array(): Uint16Array {
    return this.texels.values;
  }

  set(positions: Uint16Array): void {
    this.texels.set(positions);
  }
}

/** Positions in a rigid body. */
class FixedPlaces implements Places {
  readonly array: Float32Array;
  readonly texels: Texels<Uint16Array>;

  /** Writes the grid of the texture. */
  constructor(local: readonly number[], grid: Vector4) {
    this.array = new Float32Array(local);
    const at = texelsAt(local);
    this.texels = at.places;
    grid.copy(at.grid);
  }

  set(): void {
    throw new Error('the positions are those of a rigid body');
  }
}

/** Returns the numbers 0, 1, 2, ... */
function plainNames(count: number): Texels<Uint32Array> {
  const names = Texels.names(count);
  for (let i = 0; i < names.room; ++i) names.values[2 * i] = i;
  return names;
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
