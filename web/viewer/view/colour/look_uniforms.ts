import { Vector2, Vector4 } from 'three';
import type { DataTexture, IUniform } from 'three';
import { mapTexture } from './maps';

/** Uniforms for the positions and colours of particles. */
export interface LookUniforms extends Record<string, IUniform> {
  /** A point p is visible if dot(p, xyz) <= w. */
  clip_plane: IUniform<Vector4>;
  value_map: IUniform<DataTexture>;
  /** The values at the ends of the colour map. */
  value_range: IUniform<Vector2>;
  /** Interpolation parameter: the previous frame (0) to the newest (1). */
  phase: IUniform<number>;
  /** Simulated time between these frames [s]; 0: unknown. */
  interval: IUniform<number>;
  /** The values of rigid bodies that are drawn together; see BodyTable. */
  body_table: IUniform<DataTexture | null>;
}

export function lookUniforms(): LookUniforms {
  return {
    clip_plane: { value: new Vector4(0, 0, 0, 1) },
    value_map: { value: mapTexture() },
    value_range: { value: new Vector2(0, 1) },
    phase: { value: 1 },
    interval: { value: 0 },
    body_table: { value: null },
  };
}
