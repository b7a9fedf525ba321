import { Vector3 } from 'three';
import type { IUniform } from 'three';

/** A distance beyond all scenes [m]: where there is no wall. */
const kFar = 1e6;

/** The planes of the vat's walls at its present position [m]. */
export interface WallUniforms {
  wall_low: IUniform<Vector3>;
  wall_high: IUniform<Vector3>;
}

export function wallUniforms(): WallUniforms {
  const walls = { wall_low: { value: new Vector3() }, wall_high: { value: new Vector3() } };
  removeWalls(walls);
  return walls;
}

export function removeWalls({ wall_low, wall_high }: WallUniforms): void {
  wall_low.value.setScalar(-kFar);
  wall_high.value.setScalar(kFar);
}

/** Sets the walls to those of a box; the top only if it has a lid. */
export function setWalls(
  { wall_low, wall_high }: WallUniforms,
  { min, max }: { min: Vector3; max: Vector3 },
  hasLid: boolean,
): void {
  wall_low.value.copy(min);
  wall_high.value.copy(max);
  if (!hasLid) wall_high.value.z = kFar;
}

/** The uniforms in GLSL. */
export const kWallPlanes = /* glsl */ `
  uniform vec3 wall_low;
  uniform vec3 wall_high;
`;

/**
 * The eye's rays and the walls, in GLSL. Water in a glass vat has flat sides, but drawn spheres
 * bulge through them and have gaps between them.
 */
export const kWalls = /* glsl */ `
  ${kWallPlanes}

  /** A plane at which the ray enters the vat: distance along the ray, and normal in world axes. */
  struct Entry {
    float at;
    vec3 normal;
  };

  /** \`way\` is the direction of a ray from \`eye\` in world axes. */
  Entry entry_of(vec3 eye, vec3 way) {
    vec3 near = min((wall_low - eye) / way, (wall_high - eye) / way);
    float at = max(near.x, max(near.y, near.z));
    vec3 normal = at <= near.x ? vec3(1.0, 0.0, 0.0) : at <= near.y ? vec3(0.0, 1.0, 0.0) : vec3(0.0, 0.0, 1.0);
    return Entry(at, -normal * sign(way));
  }

  /** Returns the distance along the ray at which it leaves the vat. */
  float exit_of(vec3 eye, vec3 way) {
    vec3 far = max((wall_low - eye) / way, (wall_high - eye) / way);
    return min(far.x, min(far.y, far.z));
  }
`;
