interface RoundTrip {
  offset: number;
  duration: number;
}

const kKept = 8;

/**
 * Estimates how far the server's clock is ahead of ours from round trips: the server's time is
 * taken as that of the middle of the trip, which is wrong by half the trip at most. Of the last few
 * the shortest counts.
 */
export class ClockOffset {
  private trips: RoundTrip[] = [];

  /** `sent` and `received` by our clock, `server` by the server's; all in seconds. */
  add(sent: number, received: number, server: number): void {
    const trip = { offset: server - (sent + received) / 2, duration: received - sent };
    this.trips = [...this.trips.slice(1 - kKept), trip];
  }

  /** Seconds to add to our clock to get the server's; undefined before the first round trip. */
  get seconds(): number | undefined {
    if (this.trips.length === 0) return undefined;
    return this.trips.reduce((a, b) => (b.duration < a.duration ? b : a)).offset;
  }
}
