import { sunUniforms } from '../base/sun_uniforms';
import type { SunUniforms } from '../base/sun_uniforms';
import { wallUniforms } from '../fluid/wall_uniforms';
import type { WallUniforms } from '../fluid/wall_uniforms';
import { behindUniforms } from '../fluid/fluid_pass';
import type { BehindUniforms } from '../fluid/fluid_pass';
import { lookUniforms } from '../colour/look_uniforms';
import type { LookUniforms } from '../colour/look_uniforms';
import { floorUniforms } from '../particles/shadow_material';
import type { FloorUniforms } from '../particles/shadow_material';

/** Uniforms of the materials of all bodies, changed in place. */
export interface SharedUniforms {
  floor: FloorUniforms;
  behind: BehindUniforms;
  look: LookUniforms;
  sun: SunUniforms;
  walls: WallUniforms;
  /** The size of details of rigid bodies that are not visible [m]. */
  detail: { value: number };
}

export function sharedUniforms(): SharedUniforms {
  const floor = floorUniforms();
  return {
    floor,
    behind: behindUniforms(),
    look: lookUniforms(),
    sun: sunUniforms(floor.floor_z),
    walls: wallUniforms(),
    detail: { value: 0 },
  };
}
