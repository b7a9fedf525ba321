/** The number of frames in the statistics. */
const kWindow = 40;

/** The share of frames that arrive in time. */
const kShare = 0.9;

/** Longer gaps between frames are pauses and do not count [s]. */
const kLongestGap = 0.25;

/** The maximum delay [s]. */
const kMost = 0.2;

/** The rate at which the delay changes invisibly [s/s]. Larger changes are immediate. */
const kSlew = 0.1;
const kJump = 0.4;

/**
 * The delay from publication to display, such that the next frame arrives in time: a quantile of the
 * recent latencies plus the frame interval. The clocks of server and client can differ.
 */
export class PlayoutDelay {
  private readonly lags = new Recent();
  private readonly gaps = new Recent();
  private last: number | undefined;
  private delay: number | undefined;
  private changed = 0;

  /** Adds a frame, published at `published` (server's clock), received at `now` (local clock). */
  add(published: number, now: number): void {
    const gap = published - (this.last ?? published);
    this.last = published;
    if (gap > 0 && gap <= kLongestGap) this.gaps.add(gap);
    this.lags.add(now - published);
  }

  /** Returns the publication time to show at `now`. */
  timeAt(now: number): number {
    const wanted = this.wanted;
    const elapsed = Math.max(now - this.changed, 0);
    this.changed = now;
    const away = wanted - (this.delay ?? wanted);
    const isFar = this.delay === undefined || Math.abs(away) > kJump;
    const step = Math.min(Math.max(away, -kSlew * elapsed), kSlew * elapsed);
    this.delay = isFar ? wanted : this.delay! + step;
    return now - this.delay;
  }

  /** The delay beyond the smallest latency [s]. */
  get seconds(): number {
    return Math.max((this.delay ?? 0) - this.lags.at(0), 0);
  }

  private get wanted(): number {
    const least = this.lags.at(0);
    return Math.min(this.lags.at(kShare) + this.gaps.at(kShare), least + kMost);
  }
}

/** The most recent numbers, for quantiles. */
class Recent {
  private readonly values: number[] = [];

  add(value: number): void {
    this.values.push(value);
    if (this.values.length > kWindow) this.values.shift();
  }

  /** Returns the quantile of a share; 0 without numbers. */
  at(share: number): number {
    const sorted = [...this.values].sort((a, b) => a - b);
    return sorted[Math.min(Math.floor(share * sorted.length), sorted.length - 1)] ?? 0;
  }
}
