const kIntervals = 40;
const kSlowMs = 50;
/** A pause in drawing, not a slow picture. */
const kPauseMs = 1000;

/** Tells whether pictures that follow one another take too long, from when each was drawn. */
export class Pace {
  private last: number | undefined;
  private intervals: number[] = [];

  /** A picture was drawn at `at` [ms]; `follows`: in the animation frame after the last one's. */
  add(at: number, follows: boolean): void {
    const interval = at - (this.last ?? at);
    this.last = at;
    if (!follows || interval <= 0 || interval > kPauseMs) return;
    this.intervals.push(interval);
    if (this.intervals.length > kIntervals) this.intervals.shift();
  }

  /** Half of the last pictures took longer than is smooth. */
  get isSlow(): boolean {
    if (this.intervals.length < kIntervals) return false;
    const sorted = [...this.intervals].sort((a, b) => a - b);
    return sorted[kIntervals / 2]! > kSlowMs;
  }

  restart(): void {
    this.last = undefined;
    this.intervals = [];
  }
}
