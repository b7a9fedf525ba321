/** After this time without a picture, the last one is still [ms]. */
const kStillMs = 300;

/** The course of drawing up to an animation frame. */
export interface Course {
  /** Whether this frame and the previous one have a picture to draw, and the previous one drew it. */
  follows: boolean;
  /** Whether neither this frame nor the previous one has a picture. */
  isIdle: boolean;
  /** Whether the last picture has been in view for some time. */
  isStill: boolean;
}

/** Follows which animation frames draw a picture. */
export class AnimationFrames {
  private drewLast = false;
  /** The last frame that had something to draw, or the one after a picture [ms]. */
  private busyAt = -Infinity;

  /** Begins the frame at `at` [ms]. `hasPicture`: there is a picture to draw. */
  begin(at: number, hasPicture: boolean): Course {
    const { drewLast } = this;
    this.drewLast = false;
    const isStill = !drewLast && at - this.busyAt > kStillMs;
    // A picture can take longer than `kStillMs`.
    if (hasPicture || drewLast) this.busyAt = at;
    return { follows: hasPicture && drewLast, isIdle: !hasPicture && !drewLast, isStill };
  }

  /** Notes that the present frame draws its picture. */
  drew(): void {
    this.drewLast = true;
  }
}
