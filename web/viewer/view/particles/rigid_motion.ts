import { Matrix4, Quaternion, Vector3 } from 'three';
import type { PoseBlock } from '../../../client/index';

const kOne = new Vector3(1, 1, 1);
/** Temporary results. */
const kPlace = new Vector3();
const kTurn = new Quaternion();

/** The interpolated motion of a rigid body between its last two poses. */
export class RigidMotion {
  private readonly place = [new Vector3(), new Vector3()] as const;
  private readonly turn = [new Quaternion(), new Quaternion()] as const;
  private isKnown = false;

  /** Adds a pose. The last pose becomes the previous one. */
  add({ position, orientation: [w, x, y, z] }: PoseBlock): void {
    this.place[0].copy(this.place[1]);
    this.turn[0].copy(this.turn[1]);
    this.place[1].set(...position);
    this.turn[1].set(x, y, z, w);
    if (!this.isKnown) {
      this.place[0].copy(this.place[1]);
      this.turn[0].copy(this.turn[1]);
    }
    this.isKnown = true;
  }

  /** Ends the interpolation with the last pose. */
  rest(): void {
    this.isKnown = false;
  }

  /** Sets `to` to the transformation from body to world axes, at a phase from 0 (previous pose) to 1. */
  matrixAt(phase: number, to: Matrix4): Matrix4 {
    kPlace.lerpVectors(this.place[0], this.place[1], phase);
    return to.compose(kPlace, kTurn.slerpQuaternions(this.turn[0], this.turn[1], phase), kOne);
  }

  /** Mean velocity [m/s] and angular velocity [1/s] between the poses, `seconds` apart. */
  velocities(seconds: number, linear: Vector3, angular: Vector3): void {
    linear.set(0, 0, 0);
    angular.set(0, 0, 0);
    if (seconds <= 0) return;
    linear.subVectors(this.place[1], this.place[0]).divideScalar(seconds);
    kTurn.copy(this.turn[0]).invert().premultiply(this.turn[1]);
    const { x, y, z, w } = kTurn;
    const sine = Math.hypot(x, y, z);
    if (sine === 0) return;
    const angle = 2 * Math.atan2(sine, Math.abs(w)) * Math.sign(w || 1);
    angular.set(x, y, z).multiplyScalar(angle / sine / seconds);
  }
}
