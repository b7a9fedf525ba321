import { describe, expect, it } from 'vitest';
import { kScales, kSoftwareLevel, Resolution } from '../../../web/viewer/view/pace/resolution';

/** Draws pictures until `until` [ms]. `interval` returns the time of a picture at a scale [ms]. */
function play(
  resolution: Resolution,
  interval: (scale: number) => number,
  { from = 0, until = 20_000, follows = true, isIdle = false } = {},
): number {
  let at = from;
  while (at < until) {
    at += interval(resolution.scale);
    resolution.add(at, follows, isIdle);
  }
  return at;
}

const [full, second, third, least] = kScales;

describe('the resolution of moving pictures', () => {
  it.each([
    ['fast graphics', () => 16.7, full, false],
    ['slightly slow graphics', (scale: number) => 30 * scale ** 2, second, false],
    ['slow graphics', (scale: number) => 50 * scale ** 2, third, false],
    ['very slow graphics', (scale: number) => 400 * scale ** 2, least, true],
    ['a slow processor', () => 60, full, true],
  ])('with %s', (_, interval, scale, isFinal) => {
    const resolution = new Resolution();
    play(resolution, interval);
    expect(resolution.scale).toBe(scale);
    expect(resolution.isFinal).toBe(isFinal);
  });

  it.each([
    ['fast', () => 16.7, full],
    ['slightly slow', (scale: number) => 30 * scale ** 2, second],
    ['slow', (scale: number) => 50 * scale ** 2, third],
    ['very slow', (scale: number) => 800 * scale ** 2, least],
  ])('starts lower with software graphics, and adapts if they are %s', (_, interval, scale) => {
    const resolution = new Resolution(kSoftwareLevel);
    expect(resolution.scale).toBe(third);
    play(resolution, interval);
    expect(resolution.scale).toBe(scale);
    resolution.restart();
    expect(resolution.scale).toBe(third);
  });

  it('adapts to pictures of more than one second', () => {
    const resolution = new Resolution();
    play(resolution, (scale) => 2000 * scale ** 2, { until: 60_000 });
    expect(resolution.scale).toBe(least);
  });

  it('keeps up with a display of 30 Hz, but not with more than 60 Hz', () => {
    const slow = new Resolution();
    play(slow, () => 33.4, { until: 3000, follows: false, isIdle: true });
    play(slow, (scale) => Math.max(33.4, 40 * scale ** 2), { from: 3000 });
    expect(slow.scale).toBe(full);
    const fast = new Resolution();
    play(fast, () => 6.9, { until: 3000, follows: false, isIdle: true });
    play(fast, (scale) => 22 * scale ** 2, { from: 3000 });
    expect(fast.scale).toBe(full);
  });

  it('does not take the intervals of a busy page for those of the display', () => {
    const resolution = new Resolution(kSoftwareLevel);
    const busy = [300, 300, 300, 16.7];
    let at = 0;
    for (let i = 0; i < 60; ++i) resolution.add((at += busy[i % busy.length]!), false, true);
    play(resolution, (scale) => 400 * scale ** 2, { from: at, until: at + 20_000 });
    expect(resolution.scale).toBe(least);
  });

  it('does not fall by pauses, and is full for another scene', () => {
    const resolution = new Resolution();
    play(resolution, () => 5000, { until: 500_000 });
    play(resolution, () => 100, { follows: false });
    expect(resolution.scale).toBe(full);
    play(resolution, (scale) => 400 * scale ** 2, { from: 500_000, until: 600_000 });
    expect(resolution.scale).toBe(least);
    resolution.restart();
    expect(resolution.scale).toBe(full);
    expect(resolution.isFinal).toBe(false);
  });
});
