/** The orbit begins after this time without input [s]. */
export const kIdleSeconds = 45;

/** The orbit reaches its full rate after this time [s]. */
const kRampSeconds = 4;

/** The rate of the orbit [rad/s]: one turn in two minutes. */
const kRate = (2 * Math.PI) / 120;

/** A longer interval between pictures is a pause [s]. */
const kPauseSeconds = 0.5;

const kInputs = ['pointerdown', 'pointermove', 'wheel', 'keydown', 'touchstart'] as const;

/** Slow orbit of the camera, which starts if the user gives no input. */
export class IdleOrbit {
  private inputAt: number;
  private drawnAt = -Infinity;

  /** `source` has the events of all input; `now` returns the time [s]. */
  constructor(
    source: Pick<EventTarget, 'addEventListener'>,
    private readonly now: () => number,
  ) {
    this.inputAt = now();
    for (const type of kInputs) {
      const note = (): void => void (this.inputAt = this.now());
      source.addEventListener(type, note, { capture: true, passive: true });
    }
  }

  /** Returns the turn since the previous picture [rad]. Called once for each picture. */
  turn(): number {
    const now = this.now();
    const seconds = now - this.drawnAt;
    this.drawnAt = now;
    const idle = now - this.inputAt - kIdleSeconds;
    if (idle <= 0 || seconds > kPauseSeconds) return 0;
    return kRate * Math.min(idle / kRampSeconds, 1) * seconds;
  }
}
