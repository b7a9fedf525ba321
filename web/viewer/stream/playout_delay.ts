/** So many frames tell how late frames come. */
const kWindow = 40;

/** Later frames than this share are not waited for. */
const kShare = 0.9;

/** Longer gaps between frames are rests and tell nothing [s]. */
const kLongestGap = 0.25;

/** The picture is at most this much later than it could be [s]. */
const kMost = 0.2;

/** Seconds per second by which the delay changes, which cannot be seen; larger changes jump. */
const kSlew = 0.1;
const kJump = 0.4;

/**
 * How much later than published frames are shown, so that the next one is there in time: as late as
 * nearly all came lately, and the gap between two of them. The clocks of both sides may differ.
 */
export class PlayoutDelay {
  private readonly lags = new Recent();
  private readonly gaps = new Recent();
  private last: number | undefined;
  private delay: number | undefined;
  private changed = 0;

  /** A frame published at `published` by the server's clock came at `now` by ours. */
  add(published: number, now: number): void {
    const gap = published - (this.last ?? published);
    this.last = published;
    if (gap > 0 && gap <= kLongestGap) this.gaps.add(gap);
    this.lags.add(now - published);
  }

  /** The time of publication that is shown at `now`. */
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

  /** Beyond the quickest way of a frame here. */
  get seconds(): number {
    return Math.max((this.delay ?? 0) - this.lags.at(0), 0);
  }

  private get wanted(): number {
    const least = this.lags.at(0);
    return Math.min(this.lags.at(kShare) + this.gaps.at(kShare), least + kMost);
  }
}

/** The last numbers, by their order. */
class Recent {
  private readonly values: number[] = [];

  add(value: number): void {
    this.values.push(value);
    if (this.values.length > kWindow) this.values.shift();
  }

  /** That below which a share of them is; 0 where there are none. */
  at(share: number): number {
    const sorted = [...this.values].sort((a, b) => a - b);
    return sorted[Math.min(Math.floor(share * sorted.length), sorted.length - 1)] ?? 0;
  }
}
