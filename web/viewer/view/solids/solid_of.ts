import type { BodyDescription } from '../../../client/index';
import type { BodyUniforms } from '../particles/impostor';
import { BoundSolid } from './bound_solid';
import { geometryOf } from './shape_geometry';
import { Solid, withRest } from './solid';
import type { SolidSurface } from './solid';
import type { Surroundings } from './solid_material';

/** Returns the surface of a solid; undefined for liquids and for bodies without a shape. */
export function solidOf(
  { kind, shape, spacing, rest_positions: places }: BodyDescription,
  uniforms: BodyUniforms,
  surroundings: Surroundings,
): SolidSurface | undefined {
  if (kind === 'liquid' || !shape) return undefined;
  if (kind === 'deformable') {
    if (!places?.length || !spacing) return undefined;
    return new BoundSolid({ shape, spacing, places }, uniforms, surroundings);
  }
  const geometry = geometryOf(shape);
  if (!geometry) return undefined;
  geometry.computeBoundingBox();
  const box = geometry.boundingBox!;
  return new Solid(withRest(geometry, box), box, uniforms, surroundings);
}

export type SolidMaker = typeof solidOf;
