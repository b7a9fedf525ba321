const kWindowSeconds = 2;

/** Measures the rate of received bytes over the last seconds. */
export class FrameMeter {
  private arrivals: { at: number; bytes: number }[] = [];
  private started: number | undefined;

  /** Counts a frame of `bytes`, received at `at` [s]. */
  add(at: number, bytes: number): void {
    this.started ??= at;
    this.arrivals.push({ at, bytes });
    this.forget(at);
  }

  /** Returns the bytes per second until `at` [s]. */
  bytesPerSecond(at: number): number {
    this.forget(at);
    if (this.started === undefined) return 0;
    const seconds = Math.min(Math.max(at - this.started, 0.25), kWindowSeconds);
    return this.arrivals.reduce((sum, { bytes }) => sum + bytes, 0) / seconds;
  }

  private forget(at: number): void {
    this.arrivals = this.arrivals.filter((arrival) => arrival.at > at - kWindowSeconds);
  }
}
