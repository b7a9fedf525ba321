const kIntervals = 40;
const kSlowMs = 50;
/** A longer interval is a pause in drawing [ms]. */
const kPauseMs = 1000;

/** Detects slow drawing from the times of successive pictures. */
export class Pace {
  private last: number | undefined;
  private intervals: number[] = [];

  /** Adds a picture drawn at `at` [ms]. `follows`: the previous animation frame was drawn too. */
  add(at: number, follows: boolean): void {
    const interval = at - (this.last ?? at);
    this.last = at;
    if (!follows || interval <= 0 || interval > kPauseMs) return;
    this.intervals.push(interval);
    if (this.intervals.length > kIntervals) this.intervals.shift();
  }

  /** Whether half of the last pictures were too slow for smooth motion. */
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
