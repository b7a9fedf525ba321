import { Vector3 } from 'three';
import type { Box3 } from 'three';

/** Directions from the scene to the camera: slightly above the horizon, and beside the vertical. */
const kDirections = {
  front: [0, -1, 0.06],
  side: [1, 0, 0.06],
  top: [0, -0.04, 1],
  corner: [0.42, -1, 0.5],
} as const;

export type Preset = keyof typeof kDirections;

export const kPresets = Object.keys(kDirections) as Preset[];

/** Scenes whose width is this multiple of their height and depth are first seen from their left end. */
const kLong = 5;
const kFromEnd = [-1.2, -1, 0.34] as const;

/** Scenes whose depth is at least this part of their width are first seen from the corner. */
const kDeep = 0.5;
/** The smallest turn from the front towards the corner; edges of shallow scenes remain visible. */
const kLeastTurn = 0.3;

/** Returns the unit vector from the scene to the camera. */
export function directionOf(preset: Preset): Vector3 {
  return new Vector3(...kDirections[preset]).normalize();
}

/**
 * Returns the direction of the first view: from the corner, nearer to the front if the scene is
 * shallow, or along a long scene.
 */
export function firstDirection({ min, max }: Box3): Vector3 {
  const width = max.x - min.x;
  if (width > kLong * Math.max(max.y - min.y, max.z - min.z)) {
    return new Vector3(...kFromEnd).normalize();
  }
  const ratio = width > 0 ? (max.y - min.y) / width : 1;
  const turn = Math.min(Math.max(ratio / kDeep, kLeastTurn), 1);
  const [x, y, z] = kDirections.corner;
  return new Vector3(turn * x, y, turn * z).normalize();
}
