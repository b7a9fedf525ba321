/** Shares of the rows and columns of the display, the best first. */
export const kScales = [1, 0.8, 0.64, 0.5] as const;

/** The first index of kScales with software graphics, which are too slow for the full resolution. */
export const kSoftwareLevel = 2;

/** The number of intervals for a decision, or the least number after a time [ms]. */
const kIntervals = 30;
const kLeastIntervals = 8;
const kDecisionMs = 1500;

/** A longer interval is a pause in drawing [ms]. */
const kPauseMs = 2500;

/** The assumed period of the display until it is measured, and the least that pictures aim at [ms]. */
const kPeriodMs = 1000 / 60;

/** The quantile of intervals without pictures that is the period of the display. */
const kShortIdle = 0.1;

/** The picture is slow if the median interval exceeds the period of the display by this factor. */
const kSlow = 1.4;

/** A lower resolution must shorten the interval at least by this factor. */
const kGain = 0.92;

/**
 * Selects the resolution of moving pictures: lower if they are slower than the display, and the
 * previous one again if the lower one is not faster, because then the graphics are not the reason.
 * Rises from a first level below the full resolution until the picture is slower than the display.
 */
export class Resolution {
  private level: number;
  private mayRise = true;
  private drawn: number[] = [];
  private idle: number[] = [];
  private period = kPeriodMs;
  private lastAt: number | undefined;
  /** The median interval at the previous, higher resolution; undefined at the first. */
  private before: number | undefined;
  /** Whether another level would not help. */
  private isSettled = false;

  /** `first`: the index of kScales at the start of a scene. */
  constructor(private readonly first = 0) {
    this.level = first;
  }

  /** The share of the display's rows and columns. */
  get scale(): number {
    return kScales[this.level]!;
  }

  /** Whether the resolution does not fall any more. */
  get isFinal(): boolean {
    return this.isSettled || this.level === kScales.length - 1;
  }

  /**
   * Adds an animation frame at `at` [ms]. `follows`: it and the previous one draw a picture;
   * `isIdle`: neither does. Returns whether the resolution changes.
   */
  add(at: number, follows: boolean, isIdle: boolean): boolean {
    const interval = at - (this.lastAt ?? at);
    this.lastAt = at;
    if (interval <= 0 || interval > kPauseMs) return false;
    if (isIdle) this.measurePeriod(interval);
    if (!follows) return false;
    this.drawn.push(interval);
    const count = this.drawn.length;
    const time = this.drawn.reduce((sum, value) => sum + value, 0);
    const isEnough = count >= kIntervals || (count >= kLeastIntervals && time > kDecisionMs);
    return isEnough && this.decide();
  }

  /** Returns to the first resolution, for another scene. */
  restart(): void {
    this.level = this.first;
    this.mayRise = true;
    this.drawn = [];
    this.before = this.lastAt = undefined;
    this.isSettled = false;
  }

  private measurePeriod(interval: number): void {
    this.idle.push(interval);
    if (this.idle.length < kIntervals) return;
    // A page that loads misses most animation frames, but not all.
    this.period = Math.max(quantileOf(this.idle, kShortIdle), kPeriodMs);
    this.idle = [];
  }

  private decide(): boolean {
    const median = quantileOf(this.drawn, 0.5);
    this.drawn = [];
    if (this.isSettled) return false;
    const { before } = this;
    this.before = undefined;
    if (before !== undefined && median > kGain * before) {
      this.isSettled = true;
      --this.level;
      return true;
    }
    if (median <= kSlow * this.period) {
      if (!this.mayRise || this.level === 0) return false;
      --this.level;
      return true;
    }
    this.mayRise = false;
    if (this.isFinal) return false;
    this.before = median;
    ++this.level;
    return true;
  }
}

function quantileOf(values: readonly number[], share: number): number {
  return [...values].sort((a, b) => a - b)[Math.floor(share * values.length)]!;
}
