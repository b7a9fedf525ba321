import { Spherical, Vector3 } from 'three';

/** From where a camera looks, and at what; z is up. */
export interface Pose {
  eye: Vector3;
  target: Vector3;
}

/** How close to straight down and to level a camera may be turned [rad]. */
const kLeast = 0.02;
const kMost = 0.495 * Math.PI;

/** The pose after a turn to the right and up [rad] about what is looked at; `zoom` 2 is half as far. */
export function turned({ eye, target }: Pose, right: number, up: number, zoom: number): Pose {
  const away = eye.clone().sub(target);
  // Spherical has y up.
  const angles = new Spherical().setFromVector3(new Vector3(away.x, away.z, -away.y));
  angles.theta += right;
  angles.phi = Math.min(Math.max(angles.phi - up, kLeast), kMost);
  angles.radius /= zoom;
  const { x, y, z } = new Vector3().setFromSpherical(angles);
  return { eye: new Vector3(x, -z, y).add(target), target: target.clone() };
}

/** For addresses: six numbers of five digits. */
export function poseToText({ eye, target }: Pose): string {
  return [...eye, ...target].map((value) => Number(value.toPrecision(5))).join(',');
}

/** Reads what poseToText wrote; undefined for anything else. */
export function poseFromText(text: string): Pose | undefined {
  const parts = text.split(',').map(Number);
  const isGood = text !== '' && parts.length === 6 && parts.every(Number.isFinite);
  if (!isGood) return undefined;
  const eye = new Vector3().fromArray(parts);
  const target = new Vector3().fromArray(parts, 3);
  return eye.distanceTo(target) > 0 ? { eye, target } : undefined;
}

/** The camera that the fragment of a page's address carries as `#camera=`. */
export function linkedPose(page: string): Pose | undefined {
  return poseFromText(new URLSearchParams(new URL(page).hash.slice(1)).get('camera') ?? '');
}
