import {
  DataTexture,
  IntType,
  RGBAIntegerFormat,
  RGFormat,
  RGIntegerFormat,
  RedIntegerFormat,
  UnsignedByteType,
  UnsignedIntType,
  UnsignedShortType,
  Vector4,
} from 'three';
import type { IUniform, PixelFormat, TextureDataType } from 'three';

/**
 * Texels in a row, a power of two. The smallest permitted limit of WebGL2, 2048 rows, is sufficient
 * for 524 288 particles.
 */
export const kRow = 256;

/** three.js has no constant for this format, and accepts the name of a constant of WebGL2. */
const kRgbIntegers = 'RGB_INTEGER' as unknown as PixelFormat;

/** A texture with some numbers for each particle. */
export class Texels<Values extends Uint8Array | Uint16Array | Uint32Array | Int32Array> {
  readonly texture: DataTexture;
  readonly values: Values;

  private constructor(
    make: new (length: number) => Values,
    /** Numbers per particle. */
    private readonly size: number,
    particles: number,
    format: PixelFormat,
    type: TextureDataType,
  ) {
    const rows = Math.max(Math.ceil(particles / kRow), 1);
    this.values = new make(size * kRow * rows);
    this.texture = new DataTexture(this.values, kRow, rows, format, type);
    this.texture.needsUpdate = true;
  }

  /** Three coordinates for each particle. */
  static places(particles: number): Texels<Uint16Array> {
    return new Texels(Uint16Array, 3, particles, kRgbIntegers, UnsignedShortType);
  }

  /** Particle number, and row in the table of bodies (1, 2, ...; 0: not in the table). */
  static names(particles: number): Texels<Uint32Array> {
    return new Texels(Uint32Array, 2, particles, RGIntegerFormat, UnsignedIntType);
  }

  static shown(particles: number): Texels<Int32Array> {
    return new Texels(Int32Array, 1, particles, RedIntegerFormat, IntType);
  }

  /** Foam and isolation, 0 to 255 each. */
  static froth(particles: number): Texels<Uint8Array> {
    return new Texels(Uint8Array, 2, particles, RGFormat, UnsignedByteType);
  }

  /** Shapes of particles at the surface of a liquid; see SurfaceShapes. */
  static shapes(particles: number): Texels<Uint32Array> {
    return new Texels(Uint32Array, 4, particles, RGBAIntegerFormat, UnsignedIntType);
  }

  /** The number of particles for which it has space. */
  get room(): number {
    return this.values.length / this.size;
  }

  /** Copies numbers, to particle `at` and those after it. */
  set(numbers: Values, at = 0): void {
    this.values.set(numbers, this.size * at);
    this.changed();
  }

  /** Uploads the numbers with the next picture. */
  changed(): void {
    this.texture.needsUpdate = true;
  }

  dispose(): void {
    this.texture.dispose();
  }
}

/** For draw calls without values. */
export const kNoValues = Texels.shown(0).texture;
const kNoPlaces = Texels.places(0).texture;
const kNoNames = Texels.names(0).texture;
const kNoFroth = Texels.froth(0).texture;
const kNoShapes = Texels.shapes(0).texture;

/** The textures of the particles of a draw call. */
export interface ParticleUniforms extends Record<string, IUniform> {
  /** Positions in the newest frame. */
  center_texels: IUniform<DataTexture>;
  /** Positions in the previous frame. */
  before_texels: IUniform<DataTexture>;
  /** The coordinate 0 of positions, and their unit. */
  texel_grid: IUniform<Vector4>;
  name_texels: IUniform<DataTexture>;
  value_texels: IUniform<DataTexture>;
  froth_texels: IUniform<DataTexture>;
  shape_texels: IUniform<DataTexture>;
}

export function particleUniforms(): ParticleUniforms {
  return {
    center_texels: { value: kNoPlaces },
    before_texels: { value: kNoPlaces },
    texel_grid: { value: new Vector4(0, 0, 0, 1) },
    name_texels: { value: kNoNames },
    value_texels: { value: kNoValues },
    froth_texels: { value: kNoFroth },
    shape_texels: { value: kNoShapes },
  };
}

/** Returns textures of resting particles at these coordinates, as a flat list. */
export function texelsAt(coordinates: ArrayLike<number>): {
  places: Texels<Uint16Array>;
  grid: Vector4;
} {
  let low = Infinity;
  let high = -Infinity;
  for (let i = 0; i < coordinates.length; ++i) {
    low = Math.min(low, coordinates[i]!);
    high = Math.max(high, coordinates[i]!);
  }
  const unit = high > low ? (high - low) / 65_535 : 1;
  const places = Texels.places(coordinates.length / 3);
  places.set(Uint16Array.from(coordinates, (at) => Math.round((at - low) / unit)));
  return { places, grid: new Vector4(low, low, low, unit) };
}

/**
 * Reads the particle of a vertex, in GLSL. `vertices` is the number of vertices for each particle.
 *
 * A draw call has the vertices of all particles, and no instances: drivers that draw by the CPU draw
 * instances one by one, which takes about 40 µs for each.
 */
export function particleShader(vertices: number): string {
  return /* glsl */ `
    uniform highp usampler2D center_texels;
    uniform highp usampler2D before_texels;
    uniform vec4 texel_grid;
    uniform highp usampler2D name_texels;
    uniform highp isampler2D value_texels;
    uniform sampler2D froth_texels;

    vec3 center;
    vec3 before;
    uint number;
    int value;
    /** Of a liquid: foam, and isolation from other particles, 0 to 1. */
    vec2 froth;
    float row;
    /** The index of the vertex among those of the particle. */
    int vertex;

    vec3 on_grid(uvec3 place) {
      return texel_grid.xyz + texel_grid.w * vec3(place);
    }

    void read_particle() {
      int particle = gl_VertexID / ${vertices};
      vertex = gl_VertexID - ${vertices} * particle;
      ivec2 texel = ivec2(particle % ${kRow}, particle / ${kRow});
      center = on_grid(texelFetch(center_texels, texel, 0).xyz);
      before = on_grid(texelFetch(before_texels, texel, 0).xyz);
      uvec2 names = texelFetch(name_texels, texel, 0).xy;
      number = names.x;
      row = float(names.y);
      value = texelFetch(value_texels, texel, 0).x;
      froth = texelFetch(froth_texels, texel, 0).xy;
    }
  `;
}
