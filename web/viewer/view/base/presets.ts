import { Vector3 } from 'three';

/** Directions from the scene to the camera: slightly above the horizon, and beside the vertical. */
const kDirections = {
  front: [0, -1, 0.06],
  side: [1, 0, 0.06],
  top: [0, -0.04, 1],
  corner: [0.42, -1, 0.5],
} as const;

export type Preset = keyof typeof kDirections;

export const kPresets = Object.keys(kDirections) as Preset[];

/** Returns the unit vector from the scene to the camera. */
export function directionOf(preset: Preset): Vector3 {
  return new Vector3(...kDirections[preset]).normalize();
}
