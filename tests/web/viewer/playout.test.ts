import { beforeEach, describe, expect, it } from 'vitest';
import type { Frame } from '../../../web/client/index';
import { Playout } from '../../../web/viewer/stream/playout';

let acknowledged: number[];
let reused: number[];
let shown: number[];
let playout: Playout;

beforeEach(() => {
  [acknowledged, reused, shown] = [[], [], []];
  playout = new Playout({
    acknowledge: (number) => acknowledged.push(number),
    reuse: ({ header }) => reused.push(header.number),
  });
});

/** The n-th frame of a session that publishes 50 per second. Its clock is 1000 s ahead. */
function frame(number: number, playing = true): Frame {
  return { header: { number, published: publishedAt(number) + 1000, playing } } as Frame;
}

function publishedAt(number: number): number {
  return number / 50;
}

function advance(now: number): void {
  playout.advance(now, ({ header }) => {
    shown.push(header.number);
    return true;
  });
}

describe('frames that are shown as they come', () => {
  it('are shown in order, and the last is acknowledged once the page draws', () => {
    playout.put(frame(1), 0);
    playout.put(frame(2), 0);
    expect(acknowledged).toEqual([]);
    advance(0);
    expect(shown).toEqual([1, 2]);
    expect(acknowledged).toEqual([2]);
    advance(1);
    expect(acknowledged).toEqual([2]);
    expect(playout.phaseAt(5)).toBe(1);
    expect(playout.delaySeconds).toBe(0);
  });

  it('are given back once two others are shown, which the picture needs', () => {
    for (let n = 1; n <= 4; ++n) {
      playout.put(frame(n), n);
      advance(n);
    }
    expect(reused).toEqual([1, 2]);
  });

  it('are returned immediately if they belong to another scene', () => {
    playout.put(frame(1), 0);
    playout.advance(0, () => false);
    expect(reused).toEqual([1]);
    playout.put(frame(2), 0);
    playout.skip();
    expect(reused).toEqual([1, 2]);
    expect(acknowledged).toEqual([1, 2]);
    playout.put(frame(3), 0);
    playout.forget();
    advance(1);
    expect(acknowledged).toEqual([1, 2]);
    expect(reused).toEqual([1, 2, 3]);
  });

  it('are given back after the picture has used them, if they are forgotten', () => {
    for (let n = 1; n <= 2; ++n) {
      playout.put(frame(n), n);
      advance(n);
    }
    playout.put(frame(3), 3);
    playout.forget();
    expect(reused).toEqual([3]); // the picture shows 1 and 2
    playout.put(frame(4), 4);
    advance(4);
    expect(reused).toEqual([3, 1]);
    playout.put(frame(5), 5);
    advance(5);
    expect(reused).toEqual([3, 1, 2]);
  });
});

/** Returns the displayed position, in frames, at intervals of a tenth of a frame. */
function watch(arrivals: Map<number, number>, from: number, to: number): number[] {
  const places: number[] = [];
  for (let tenth = 10 * from; tenth < 10 * to; ++tenth) {
    const now = publishedAt(tenth / 10);
    for (const [number, at] of arrivals) {
      if (at > now) continue;
      playout.put(frame(number), at);
      arrivals.delete(number);
    }
    advance(now);
    const last = shown.at(-1);
    const before = shown.at(-2) ?? last;
    const phase = playout.phaseAt(now);
    if (last !== undefined) places.push(before! + phase * (last - before!));
  }
  return places;
}

function largestStep(places: number[]): number {
  return Math.max(...places.slice(1).map((place, i) => Math.abs(place - places[i]!)));
}

describe('smooth motion', () => {
  beforeEach(() => (playout.smooth = true));

  it('is even if some frames are late', () => {
    const late = [0.004, 0.012, 0.001, 0.015, 0.007];
    const arrivals = new Map(
      Array.from({ length: 200 }, (_, n) => [n, publishedAt(n) + 0.005 + late[n % 5]!]),
    );
    const places = watch(arrivals, 0, 190).slice(600);
    expect(largestStep(places)).toBeLessThan(0.12); // a tenth, plus the change of the delay
    expect(Math.min(...places.slice(1).map((place, i) => place - places[i]!))).toBeGreaterThan(
      0.08,
    );
    // At least the lateness of the frames and the 20 ms between two of them.
    expect(playout.delaySeconds).toBeGreaterThan(0.02);
    expect(playout.delaySeconds).toBeLessThan(0.02 + 0.016);
  });

  it('is even if frames are dropped', () => {
    const arrivals = new Map(
      Array.from({ length: 200 }, (_, n): [number, number] => [n, publishedAt(n) + 0.01]).filter(
        ([n]) => n < 60 || n % 3 === 0,
      ),
    );
    const places = watch(arrivals, 0, 190).slice(1000);
    expect(largestStep(places)).toBeLessThan(0.12);
  });

  it('is never more than a fifth of a second late', () => {
    const arrivals = new Map(
      Array.from({ length: 100 }, (_, n) => [n, publishedAt(n) + (n % 2 ? 0.9 : 0)]),
    );
    watch(arrivals, 0, 90);
    expect(playout.delaySeconds).toBeLessThanOrEqual(0.2 + 1e-9);
  });

  it('shows bodies at rest immediately', () => {
    playout.put(frame(1), publishedAt(1));
    playout.put(frame(2), publishedAt(2));
    playout.put(frame(3, false), publishedAt(3));
    advance(publishedAt(3));
    expect(shown).toEqual([1, 2, 3]);
    expect(playout.phaseAt(publishedAt(3))).toBe(1);
  });
});
