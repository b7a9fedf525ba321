import { Vector3 } from 'three';
import type { Pose } from '../view/base/pose';

/** The time in which the camera covers 63 % of its distance to the body [s]. */
const kLag = 0.15;

/** Distance to the body / distance of the camera, below which the last step reaches the body. */
const kLast = 1e-4;

/** The same, below which the camera rests; larger than rounding errors. */
const kRest = 1e-9;

/** Moves a camera with a body: the target approaches the body, and the eye keeps its direction. */
export class Chase {
  private last: number | undefined;

  /** `hasLag`: without a lag, the target is on the body in every picture. */
  constructor(private readonly hasLag: boolean) {}

  /** Returns the pose at `now` [s] for a body at `place`; undefined if the camera rests. */
  follow({ eye, target }: Pose, place: Vector3, now: number): Pose | undefined {
    const seconds = now - (this.last ?? now);
    this.last = now;
    const step = place.clone().sub(target);
    const share = step.length() / eye.distanceTo(target);
    if (share < kRest) return undefined;
    if (this.hasLag && share > kLast) {
      if (seconds <= 0) return undefined;
      step.multiplyScalar(1 - Math.exp(-seconds / kLag));
    }
    return { eye: eye.clone().add(step), target: target.clone().add(step) };
  }
}
