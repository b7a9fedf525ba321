import { DataTexture, FloatType, RGBAFormat } from 'three';
import type { Matrix4 } from 'three';
import type { LookUniforms } from '../colour/look_uniforms';
import type { BodyUniforms } from './impostor';

/** Texels of a row, and the number of values in a texel. */
const kTexels = 7;
const kValues = 4;

/** Writes the values of bodies to the texture, one row per body. */
export class BodyTable {
  private texture: DataTexture | undefined;
  private values = new Float32Array(0);

  constructor(private readonly uniforms: Pick<LookUniforms, 'body_table'>) {}

  /** Makes room for at least `rows` bodies. */
  reserve(rows: number): void {
    const size = kTexels * kValues * rows;
    if (this.texture && size <= this.values.length) return;
    this.texture?.dispose();
    this.values = new Float32Array(size);
    this.texture = new DataTexture(this.values, kTexels, rows, RGBAFormat, FloatType);
    this.uniforms.body_table.value = this.texture;
  }

  /**
   * Writes row 0, 1, … `length` is the body's longest side, `radius` that of its particles [m]. A
   * liquid has an absorption `density`, relative to the reference of the scene.
   */
  write(
    row: number,
    { elements: m }: Matrix4,
    body: BodyUniforms,
    { length, radius, density = 1 }: { length: number; radius: number; density?: number },
  ): void {
    const { roughness, metalness, variant, colour, colour_source, linear, angular } = body;
    const { r, g, b } = colour.value;
    const [v, w] = [linear.value, angular.value];
    const texels = [
      [m[0], m[1], m[2], roughness.value],
      [m[4], m[5], m[6], metalness.value],
      [m[8], m[9], m[10], variant.value],
      [r, g, b, colour_source.value],
      [m[12], m[13], m[14], length],
      [v.x, v.y, v.z, radius],
      [w.x, w.y, w.z, density],
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
