import type { BodyDescription, SceneShape } from '../../../client/index';
import type { BodyUniforms } from '../particles/impostor';
import { BoundSolid } from './bound_solid';
import { geometryOf } from './shape_geometry';
import { Solid, withRest } from './solid';
import type { SolidSurface } from './solid';
import type { Surroundings } from './solid_material';

/** Returns the surface of a solid; undefined for liquids and for bodies without a shape. */
export function solidOf(
  body: BodyDescription,
  uniforms: BodyUniforms,
  surroundings: Surroundings,
): SolidSurface | undefined {
  const { kind, spacing, rest_positions: places } = body;
  const shape = body.shape ?? ballOf(body);
  if (kind === 'liquid' || !shape) return undefined;
  if (kind === 'deformable') {
    if (!places?.length || !spacing) return undefined;
    return new BoundSolid({ shape, spacing, places }, uniforms, surroundings);
  }
  const geometry = geometryOf(shape, surroundings.detail.value);
  if (!geometry) return undefined;
  geometry.computeBoundingBox();
  const box = geometry.boundingBox!;
  return new Solid(withRest(geometry, box), box, uniforms, surroundings);
}

/** Returns the shape of a rigid body of one particle. */
function ballOf({
  local_positions: [x, y, z, more] = [],
  radius,
}: BodyDescription): SceneShape | undefined {
  if (x === undefined || y === undefined || z === undefined || more !== undefined) return undefined;
  return { type: 'sphere', radius, center: [x, y, z] };
}

export type SolidMaker = typeof solidOf;
