import { Vector2, Vector4 } from 'three';
import type { DataTexture, IUniform } from 'three';
import { mapTexture } from './colour/maps';
import { behindUniforms } from './fluid/fluid_pass';
import type { BehindUniforms } from './fluid/fluid_pass';
import { floorUniforms } from './shadow_material';
import type { FloorUniforms } from './shadow_material';

/** How particles are placed and coloured. */
export interface LookUniforms extends Record<string, IUniform> {
  /** A place p is seen where dot(p, xyz) <= w. */
  clip_plane: IUniform<Vector4>;
  value_map: IUniform<DataTexture>;
  /** The values at the map's ends. */
  value_range: IUniform<Vector2>;
  /** From the frame before (0) to the newest (1). */
  phase: IUniform<number>;
  /** Simulated time between these two [s]; 0: not known. */
  interval: IUniform<number>;
}

/** What materials of all bodies share: one object each, changed in place. */
export interface SharedUniforms {
  floor: FloorUniforms;
  behind: BehindUniforms;
  look: LookUniforms;
}

export function sharedUniforms(): SharedUniforms {
  const look: LookUniforms = {
    clip_plane: { value: new Vector4(0, 0, 0, 1) },
    value_map: { value: mapTexture() },
    value_range: { value: new Vector2(0, 1) },
    phase: { value: 1 },
    interval: { value: 0 },
  };
  return { floor: floorUniforms(), behind: behindUniforms(), look };
}
