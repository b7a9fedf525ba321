import { describe, expect, it } from 'vitest';
import type { SessionStats } from '../../../web/client/index';
import { History } from '../../../web/viewer/curves/history';
import { diagnosticSeries, kCharts } from '../../../web/viewer/curves/series';
import { profileBetween, profileInWords } from '../../../web/viewer/curves/stage_words';

function stats(ticks: number, seconds: number, stages: Record<string, number>): SessionStats {
  return {
    tick: ticks,
    instruction_set: 'avx2',
    threads: 1,
    time: 0,
    real_time_factor: 1,
    particles: 1,
    sleeping_bodies: 0,
    ticks,
    substeps: ticks,
    undone_substeps: 0,
    seconds,
    longest_tick: 0,
    stages: Object.entries(stages).map(([stage, spent]) => ({ stage, calls: 1, seconds: spent })),
  };
}

describe('the computing time of ticks', () => {
  const before = stats(10, 1, { find_pairs: 0.5, kick: 0.5 });

  it('is the increase since the last look, per tick, in descending order', () => {
    const now = stats(20, 1.4, {
      find_pairs: 0.6,
      sort_liquid: 0.1,
      kick: 0.5,
      liquid_forces: 0.2,
    });
    const { seconds, parts } = profileBetween(before, now)!;
    expect(seconds).toBeCloseTo(0.04);
    expect(parts.slice(0, 2).map(({ words }) => words)).toEqual(
      expect.arrayContaining(['finding neighbours', 'forces in liquids']),
    );
    expect(parts.map(({ share }) => share)).toEqual([
      expect.closeTo(0.5),
      expect.closeTo(0.5),
      expect.closeTo(0),
    ]);
  });

  it('is all of it once a scene was loaded, which counts from 0 again', () => {
    const { seconds } = profileBetween(before, stats(5, 0.5, { kick: 0.5 }))!;
    expect(seconds).toBeCloseTo(0.1);
  });

  it('is empty without ticks', () => {
    expect(profileBetween(before, before)).toBeUndefined();
  });

  it('counts a stage that this page does not know as other work', () => {
    const { parts } = profileBetween(undefined, stats(1, 1, { of_tomorrow: 1 }))!;
    expect(parts[0]!.words).toBe('other work');
  });

  it('is described in words, with the available time', () => {
    const profile = profileBetween(undefined, stats(10, 0.1, { find_pairs: 0.09, kick: 0.01 }))!;
    expect(profileInWords(profile, 0.02, 1)).toBe(
      'A tick takes 10 ms of the 20 ms that it may take, so the speed is reached. The largest part is finding neighbours: 90 %.',
    );
    expect(profileInWords(profile, 0.02, 4)).toContain('runs 2 times slower than the set speed');
    const slow = profileInWords({ ...profile, seconds: 17.04 }, 0.02, 1);
    expect(slow).toContain('A tick takes 17000 ms of the 20 ms');
    expect(slow).toContain('runs 850 times slower');
  });
});

describe('History', () => {
  it('merges values of one time, has gaps, and restarts if the time decreases', () => {
    const history = new History(['a', 'b']);
    history.add(1, { a: 1 });
    history.add(1, { b: 2 });
    history.add(2, { a: 3 });
    expect(history.columns(['a', 'b'])).toEqual([
      [1, 2],
      [1, 3],
      [2, null],
    ]);
    expect(history.newest('b')).toBe(2);
    history.add(0.5, { a: 4 });
    expect(history.columns(['a', 'b'])).toEqual([[0.5], [4], [null]]);
  });

  it('keeps the first and the newest values for any duration', () => {
    const history = new History(['a']);
    for (let n = 0; n < 5000; ++n) history.add(n, { a: n });
    const [times, values] = history.columns(['a']);
    expect(times.length).toBeLessThanOrEqual(600);
    expect(times[0]).toBe(0);
    expect(times.slice(-100)).toEqual(Array.from({ length: 100 }, (_, n) => 4900 + n));
    expect(values).toEqual(times);
  });
});

describe('diagnosticSeries', () => {
  const diagnostics = {
    kinetic_energy: 1,
    gravitational_energy: 2,
    elastic_energy: 3,
    contact_energy: 4,
    momentum: [3, 0, 4] as [number, number, number],
    angular_momentum: [0, 0, 0] as [number, number, number],
    mean_density_error: 5,
    max_density_error: 6,
    torn_springs: 0,
    emitted_particles: 0,
    drained_particles: 0,
  };

  it('has a torque in scenes with axles only', () => {
    expect(diagnosticSeries(diagnostics)).toMatchObject({ kinetic: 1, momentum: 5, densest: 6 });
    expect(diagnosticSeries(diagnostics)).not.toHaveProperty('torque');
    expect(diagnosticSeries({ ...diagnostics, axle_torque: -2 })).toHaveProperty('torque', -2);
  });

  it('hides the chart of the torque while it has no values', () => {
    const special = kCharts.filter(({ isSpecial }) => isSpecial).map(({ title }) => title);
    expect(special).toEqual(['Torque on axles']);
  });
});
