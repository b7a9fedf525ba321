import { describe, expect, it } from 'vitest';
import { levelText } from '../../../web/viewer/panel/levels';

describe('levelText', () => {
  it('names the level, its expected speed and the offered level', () => {
    const entry = { level: 'fine', particles: 20_000, real_time_factor: 1.304 } as const;
    expect(levelText(entry, 'fine')).toBe('✓ fine · 1.3×');
    expect(levelText(entry, 'normal')).toBe('fine · 1.3×');
    expect(levelText({ ...entry, real_time_factor: 12.4 }, 'normal')).toBe('fine · 12×');
  });
});
