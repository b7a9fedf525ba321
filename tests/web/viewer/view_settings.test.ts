import { describe, expect, it } from 'vitest';
import { decideStyle } from '../../../web/viewer/view/base/liquid_style';
import { Pace } from '../../../web/viewer/view/pace/pace';
import {
  defaultSettings,
  settingsFromText,
  settingsToText,
} from '../../../web/viewer/view/base/settings';
import { linkedSettings, SettingsStore } from '../../../web/viewer/view/base/settings_store';
import { kNoShelf, shelfOf } from '../../../web/viewer/view/base/shelf';
import type { Shelf } from '../../../web/viewer/view/base/shelf';

function shelf(text: string | null = null): Shelf & { text: string | null } {
  return {
    text,
    getItem() {
      return this.text;
    },
    setItem(_, value) {
      this.text = value;
    },
  };
}

describe('the text of settings', () => {
  it('contains only settings that differ from the defaults', () => {
    expect(settingsToText(defaultSettings())).toBe('');
    expect(settingsToText({ ...defaultSettings(), liquid: 'splats' })).toBe('liquid:splats');
  });

  it('is read back, whatever is set', () => {
    const settings = {
      ...defaultSettings(),
      liquid: 'fluid' as const,
      colour: 'speed' as const,
      from: -1.5,
      to: 0,
      clip: 'z' as const,
      clipAt: 0.25,
      clipOther: true,
    };
    expect(settingsFromText(settingsToText(settings))).toEqual(settings);
  });

  it('has the default for an invalid value', () => {
    expect(settingsFromText('liquid:fluid').liquid).toBe('fluid');
    for (const text of [
      '',
      'liquid',
      'liquid:',
      'liquid:wine',
      'toString:x',
      ',,:,',
      'a:b',
      'from:x',
      'clipAt:NaN',
    ]) {
      expect(settingsFromText(text)).toEqual(defaultSettings());
    }
  });
});

describe('SettingsStore', () => {
  it('begins with a link, else with the last visit', () => {
    expect(new SettingsStore(shelf('liquid:splats'), 'liquid:fluid').settings.liquid).toBe('fluid');
    expect(new SettingsStore(shelf('liquid:splats')).settings.liquid).toBe('splats');
    expect(linkedSettings('http://x/?session=s1#invite=t&view=liquid:fluid')).toBe('liquid:fluid');
    expect(linkedSettings('http://x/#invite=t')).toBeUndefined();
  });

  it('reports and keeps changes, also in browsers without storage', () => {
    const kept = shelf();
    const store = new SettingsStore(kept);
    const told: string[] = [];
    store.subscribe(({ liquid }) => told.push(liquid));
    store.change({ liquid: 'particles' });
    expect(told).toEqual(['auto', 'particles']);
    expect(kept.text).toBe('liquid:particles');
    const refuse = (): never => {
      throw new Error('storage is off');
    };
    const forgetful = new SettingsStore({ getItem: refuse, setItem: refuse });
    forgetful.change({ liquid: 'fluid' });
    expect(forgetful.settings.liquid).toBe('fluid');
  });

  it('works in a frame whose browser denies access to the storage', () => {
    const kept = shelf('liquid:splats');
    const denied = {
      sessionStorage: kept,
      get localStorage(): Shelf {
        throw new DOMException('access is denied', 'SecurityError');
      },
    };
    expect(shelfOf(denied, 'sessionStorage')).toBe(kept);
    expect(shelfOf(denied, 'localStorage')).toBe(kNoShelf);
    expect(new SettingsStore(shelfOf(denied, 'localStorage')).text).toBe('');
  });
});

describe('the style of liquids', () => {
  const card = { isSoftware: false, drawsToFloats: true };
  const processor = { isSoftware: true, drawsToFloats: true };
  const weak = { isSoftware: false, drawsToFloats: false };

  it('is the best that is fast, and any that was chosen', () => {
    expect(decideStyle('auto', card, false, 1000)).toEqual({ style: 'fluid', words: undefined });
    expect(decideStyle('auto', card, true, 1000).style).toBe('splats');
    expect(decideStyle('auto', processor, false, 1000).style).toBe('splats');
    expect(decideStyle('fluid', card, true, 1000).style).toBe('fluid');
    expect(decideStyle('fluid', processor, false, 1000).style).toBe('fluid');
    expect(decideStyle('particles', processor, false, 1000)).toEqual({
      style: 'particles',
      words: undefined,
    });
  });

  it('is no surface for more particles than one can be made around in time', () => {
    expect(decideStyle('surface', card, false, 20_000).style).toBe('surface');
    const { style, words } = decideStyle('surface', card, false, 20_001);
    expect(style).toBe('splats');
    expect(words).toMatch(/20000 particles/);
  });

  it('is a possible style, with the reason for a replacement', () => {
    for (const chosen of ['auto', 'fluid'] as const) {
      const { style, words } = decideStyle(chosen, weak, false, 1000);
      expect(style).toBe('splats');
      expect(words).toMatch(/cannot draw/);
    }
    expect(decideStyle('fluid', processor, false, 1000).words).toMatch(/without a graphics card/);
  });
});

describe('Pace', () => {
  function paceOf(intervals: number[], follows = true): Pace {
    const pace = new Pace();
    let at = 0;
    pace.add(at, false);
    for (const interval of intervals) pace.add((at += interval), follows);
    return pace;
  }

  it('is slow once half of the last pictures took too long', () => {
    const slow = new Array<number>(40).fill(80);
    expect(paceOf(slow).isSlow).toBe(true);
    expect(paceOf(slow.slice(1)).isSlow).toBe(false);
    expect(paceOf(slow.map((t, i) => (i % 3 === 0 ? t : 16))).isSlow).toBe(false);
    expect(paceOf([...slow, ...slow.map(() => 16)]).isSlow).toBe(false);
  });

  it('does not take rest for slowness', () => {
    expect(paceOf(new Array<number>(80).fill(400), false).isSlow).toBe(false);
    expect(paceOf(new Array<number>(80).fill(5000)).isSlow).toBe(false);
  });
});
