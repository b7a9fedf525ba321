import { Spherical, Vector3 } from 'three';

/** Position and target of a camera; z is up. */
export interface Pose {
  eye: Vector3;
  target: Vector3;
}

/** Minimum angle of a camera to vertical and to horizontal [rad]. */
const kLeast = 0.02;
const kMost = 0.495 * Math.PI;

/** Returns the pose after a rotation about the target [rad]. `zoom` 2 halves the distance. */
export function turned({ eye, target }: Pose, right: number, up: number, zoom: number): Pose {
  const away = eye.clone().sub(target);
  // In Spherical, y is up.
  const angles = new Spherical().setFromVector3(new Vector3(away.x, away.z, -away.y));
  angles.theta += right;
  angles.phi = Math.min(Math.max(angles.phi - up, kLeast), kMost);
  angles.radius /= zoom;
  const { x, y, z } = new Vector3().setFromSpherical(angles);
  return { eye: new Vector3(x, -z, y).add(target), target: target.clone() };
}

/** Returns the pose for addresses: six numbers of five digits. */
export function poseToText({ eye, target }: Pose): string {
  return [...eye, ...target].map((value) => Number(value.toPrecision(5))).join(',');
}

/** Reads a text of poseToText; undefined if it is invalid. */
export function poseFromText(text: string): Pose | undefined {
  const parts = text.split(',').map(Number);
  const isGood = text !== '' && parts.length === 6 && parts.every(Number.isFinite);
  if (!isGood) return undefined;
  const eye = new Vector3().fromArray(parts);
  const target = new Vector3().fromArray(parts, 3);
  return eye.distanceTo(target) > 0 ? { eye, target } : undefined;
}

/** Returns the camera in the fragment of the page's address, `#camera=`. */
export function linkedPose(page: string): Pose | undefined {
  return poseFromText(new URLSearchParams(new URL(page).hash.slice(1)).get('camera') ?? '');
}
