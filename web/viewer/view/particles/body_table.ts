import { DataTexture, FloatType, RGBAFormat } from 'three';
import type { IUniform, Matrix4 } from 'three';
import type { BodyUniforms } from './impostor';

/** Texels of a row, and the number of values in a texel. */
const kTexels = 7;
const kValues = 4;

/** The texture with the values of bodies that are drawn together; see kBody. */
export interface TableUniforms {
  body_table: IUniform<DataTexture | null>;
}

export function tableUniforms(): TableUniforms {
  return { body_table: { value: null } };
}

/**
 * The values of the body that a vertex belongs to, in GLSL. `row` is an attribute: 1, 2, … for the
 * rows of the table. It is 0 without the attribute, and the values are then those of the mesh.
 */
export const kBody = /* glsl */ `
  in float row;
  uniform highp sampler2D body_table;
  uniform vec3 colour;
  uniform int colour_source;
  uniform float roughness;
  uniform float metalness;
  uniform float variant;
  uniform float body_length;
  uniform vec3 linear;
  uniform vec3 angular;

  struct Body {
    mat4 to_world;
    vec3 colour;
    int colour_source;
    /** Roughness, metalness, variant, length. */
    vec4 matter;
    vec3 linear;
    vec3 angular;
  };

  vec4 entry(int n) {
    return texelFetch(body_table, ivec2(n, int(row) - 1), 0);
  }

  Body this_body() {
    if (row < 0.5) {
      vec4 matter = vec4(roughness, metalness, variant, body_length);
      return Body(modelMatrix, colour, colour_source, matter, linear, angular);
    }
    vec4 x = entry(0), y = entry(1), z = entry(2), shade = entry(3), at = entry(4);
    mat4 to_world = mat4(vec4(x.xyz, 0.0), vec4(y.xyz, 0.0), vec4(z.xyz, 0.0), vec4(at.xyz, 1.0));
    vec4 matter = vec4(x.w, y.w, z.w, at.w);
    return Body(to_world, shade.rgb, int(shade.w), matter, entry(5).xyz, entry(6).xyz);
  }
`;

/** Writes the values of bodies to the texture, one row per body. */
export class BodyTable {
  private texture: DataTexture | undefined;
  private values = new Float32Array(0);

  constructor(private readonly uniforms: TableUniforms) {}

  /** Makes room for at least `rows` bodies. */
  reserve(rows: number): void {
    const size = kTexels * kValues * rows;
    if (this.texture && size <= this.values.length) return;
    this.texture?.dispose();
    this.values = new Float32Array(size);
    this.texture = new DataTexture(this.values, kTexels, rows, RGBAFormat, FloatType);
    this.uniforms.body_table.value = this.texture;
  }

  /** Writes row 0, 1, … `length` is the body's longest side [m]. */
  write(row: number, { elements: m }: Matrix4, body: BodyUniforms, length: number): void {
    const { roughness, metalness, variant, colour, colour_source, linear, angular } = body;
    const { r, g, b } = colour.value;
    const [v, w] = [linear.value, angular.value];
    const texels = [
      [m[0], m[1], m[2], roughness.value],
      [m[4], m[5], m[6], metalness.value],
      [m[8], m[9], m[10], variant.value],
      [r, g, b, colour_source.value],
      [m[12], m[13], m[14], length],
      [v.x, v.y, v.z, 0],
      [w.x, w.y, w.z, 0],
    ];
    this.values.set(texels.flat(), kTexels * kValues * row);
  }

  /** Uploads the written values with the next picture. */
  finish(): void {
    if (this.texture) this.texture.needsUpdate = true;
  }

  dispose(): void {
    this.texture?.dispose();
    this.uniforms.body_table.value = null;
  }
}
