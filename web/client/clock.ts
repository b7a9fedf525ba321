interface RoundTrip {
  offset: number;
  duration: number;
}

const kKept = 8;

/**
 * Estimates the offset of the server's clock from round trips. It assumes that the server replies in
 * the middle of a trip, with an error of at most half of the trip. The shortest of the last trips
 * counts.
 */
export class ClockOffset {
  private trips: RoundTrip[] = [];

  /** `sent` and `received` are times of the local clock [s], `server` of the server's clock [s]. */
  add(sent: number, received: number, server: number): void {
    const trip = { offset: server - (sent + received) / 2, duration: received - sent };
    this.trips = [...this.trips.slice(1 - kKept), trip];
  }

  /** The server's time minus the local time [s]; undefined before the first round trip. */
  get seconds(): number | undefined {
    if (this.trips.length === 0) return undefined;
    return this.trips.reduce((a, b) => (b.duration < a.duration ? b : a)).offset;
  }
}
