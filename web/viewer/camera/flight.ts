import { Vector3 } from 'three';
import type { Pose } from '../view/base/pose';

/** The duration of a flight [s]. */
export const kFlightSeconds = 0.7;

/** A camera movement from one pose to another, on an arc around the target. */
export class Flight {
  private readonly from: Arc;
  private readonly to: Arc;

  /** `start` [s]. */
  constructor(
    from: Pose,
    private readonly end: Pose,
    private readonly start: number,
  ) {
    this.from = arcOf(from);
    this.to = arcOf(end);
    const turn = this.to.azimuth - this.from.azimuth;
    this.to.azimuth -= 2 * Math.PI * Math.round(turn / (2 * Math.PI)); // the shorter way
  }

  isOver(now: number): boolean {
    return now - this.start >= kFlightSeconds;
  }

  /** Returns the pose at a time [s]. */
  poseAt(now: number): Pose {
    if (this.isOver(now)) return this.end;
    const time = Math.max((now - this.start) / kFlightSeconds, 0);
    const share = time * time * (3 - 2 * time);
    const mix = (a: number, b: number): number => a + share * (b - a);
    const { from, to } = this;
    const target = from.target.clone().lerp(to.target, share);
    const rise = mix(from.elevation, to.elevation);
    const azimuth = mix(from.azimuth, to.azimuth);
    const distance = Math.exp(mix(Math.log(from.distance), Math.log(to.distance)));
    const way = new Vector3(
      Math.cos(rise) * Math.cos(azimuth),
      Math.cos(rise) * Math.sin(azimuth),
      Math.sin(rise),
    );
    return { eye: way.multiplyScalar(distance).add(target), target };
  }
}

interface Arc {
  target: Vector3;
  distance: number;
  azimuth: number;
  elevation: number;
}

function arcOf({ eye, target }: Pose): Arc {
  const away = eye.clone().sub(target);
  const distance = away.length();
  return {
    target,
    distance,
    azimuth: Math.atan2(away.y, away.x),
    elevation: Math.asin(away.z / distance),
  };
}
