import { describe, expect, it } from 'vitest';
import { ClockOffset } from '../../../web/client/index';

describe('ClockOffset', () => {
  it('knows nothing before the first round trip', () => {
    expect(new ClockOffset().seconds).toBeUndefined();
  });

  it('takes the server to have answered in the middle of the trip', () => {
    const clock = new ClockOffset();
    clock.add(10, 12, 111);
    expect(clock.seconds).toBe(100);
  });

  it('trusts the shortest of the trips', () => {
    const clock = new ClockOffset();
    clock.add(0, 4, 103);
    clock.add(10, 10.5, 110.25);
    clock.add(20, 23, 122);
    expect(clock.seconds).toBe(100);
  });

  it('forgets a trip after eight', () => {
    const clock = new ClockOffset();
    clock.add(0, 0, 100);
    for (let i = 1; i < 8; ++i) clock.add(i, i + 1, i + 201);
    expect(clock.seconds).toBe(100);
    clock.add(8, 9, 209);
    expect(clock.seconds).toBe(200.5);
  });
});
