import { behindUniforms } from './fluid/fluid_pass';
import type { BehindUniforms } from './fluid/fluid_pass';
import { lookUniforms } from './look_uniforms';
import type { LookUniforms } from './look_uniforms';
import { floorUniforms } from './shadow_material';
import type { FloorUniforms } from './shadow_material';

/** Uniforms of the materials of all bodies, changed in place. */
export interface SharedUniforms {
  floor: FloorUniforms;
  behind: BehindUniforms;
  look: LookUniforms;
}

export function sharedUniforms(): SharedUniforms {
  return { floor: floorUniforms(), behind: behindUniforms(), look: lookUniforms() };
}
