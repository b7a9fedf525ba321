import type { Vector3 } from 'three';
import { turned } from '../view/base/pose';
import type { Pose } from '../view/base/pose';
import { Chase } from './chase';
import { Flight } from './flight';
import type { IdleOrbit } from './idle_orbit';
import { directionOf } from '../view/base/presets';
import type { Preset } from '../view/base/presets';

/** The camera that this class moves. */
export interface MovedCamera {
  pose: Pose;
  /** Returns the pose that has the whole scene in view, from this direction. */
  poseFrom(direction: Vector3): Pose | undefined;
  /** Whether the next animation frame draws a picture. */
  readonly isStale: boolean;
}

/** Movements of the camera without the pointer: presets, following of a body, slow orbit. */
export class CameraMotion {
  private flight: Flight | undefined;
  private followed: number | undefined;
  private chase = new Chase(false);
  /** Whether the camera orbits the scene if the user gives no input. */
  orbits = true;

  /** `isCalm` returns whether the user prefers reduced motion. */
  constructor(
    private readonly camera: MovedCamera,
    private readonly placeOf: (body: number) => Vector3 | undefined,
    private readonly orbit: IdleOrbit,
    private readonly isCalm: () => boolean,
  ) {}

  /** Moves the camera to a preset. */
  show(preset: Preset, now: number): void {
    const end = this.camera.poseFrom(directionOf(preset));
    if (!end) return;
    this.follow(undefined);
    this.flight = new Flight(this.camera.pose, end, this.isCalm() ? -Infinity : now);
  }

  /** Follows a body; undefined: none. */
  follow(body: number | undefined): void {
    this.flight = undefined;
    this.followed = body;
    this.chase = new Chase(!this.isCalm());
  }

  /** The followed body. */
  get body(): number | undefined {
    return this.followed;
  }

  /** Ends a flight, because the user moves the camera. */
  interrupt(): void {
    this.flight = undefined;
  }

  /** Moves the camera to its pose at `now` [s]. Called once per animation frame. */
  update(now: number): void {
    if (this.flight) {
      this.camera.pose = this.flight.poseAt(now);
      if (this.flight.isOver(now)) this.flight = undefined;
    }
    const place = this.followed === undefined ? undefined : this.placeOf(this.followed);
    const pose = place && this.chase.follow(this.camera.pose, place, now);
    if (pose) this.camera.pose = pose;
    // The orbit adds no pictures, so that a paused scene is not drawn.
    if (!this.camera.isStale) return;
    const turn = this.orbit.turn();
    if (turn > 0 && this.orbits && !this.flight && !this.isCalm()) {
      this.camera.pose = turned(this.camera.pose, turn, 0, 1);
    }
  }
}
