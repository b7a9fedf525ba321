import { Box3, Vector3, Vector4 } from 'three';
import { describe, expect, it } from 'vitest';
import { setClipPlane } from '../../../web/viewer/view/base/clip';
import { mapColour } from '../../../web/viewer/view/colour/maps';
import { formatQuantity, quantityError } from '../../../web/viewer/view/colour/quantity';
import { AutoRange } from '../../../web/viewer/view/colour/range';

/** Returns the lightness L* (CIE 1976) of a colour, 0 to 100. */
function lightness(colour: readonly number[]): number {
  const [r, g, b] = colour.map((part) => {
    const value = part / 255;
    return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
  });
  const luminance = 0.2126 * r! + 0.7152 * g! + 0.0722 * b!;
  return luminance > 0.008856 ? 116 * Math.cbrt(luminance) - 16 : 903.3 * luminance;
}

describe('colour maps', () => {
  it.each(['viridis', 'cividis'] as const)('%s grows evenly lighter', (name) => {
    const steps = Array.from({ length: 101 }, (_, i) => lightness(mapColour(name, i / 100)));
    const rises = steps.slice(1).map((step, i) => step - steps[i]!);
    const mean = (steps[100]! - steps[0]!) / 100;
    expect(mean).toBeGreaterThan(0.7);
    expect(Math.min(...rises)).toBeGreaterThan(0);
    expect(Math.max(...rises)).toBeLessThan(2.5 * mean);
  });

  it('blue-red is lightest in its middle and as dark at both ends', () => {
    const at = (place: number): number => lightness(mapColour('blue-red', place));
    expect(at(0.5)).toBeGreaterThan(95);
    expect(Math.abs(at(0) - at(1))).toBeLessThan(5);
    expect(mapColour('blue-red', 0)[2]).toBeGreaterThan(mapColour('blue-red', 0)[0]);
    expect(mapColour('blue-red', 1)[0]).toBeGreaterThan(mapColour('blue-red', 1)[2]);
  });

  it('end with their ends', () => {
    expect(mapColour('viridis', -1)).toEqual([0x44, 0x01, 0x54]);
    expect(mapColour('viridis', 2)).toEqual([0xfd, 0xe7, 0x25]);
  });
});

describe('AutoRange', () => {
  it('widens at once and narrows slowly', () => {
    const range = new AutoRange(false);
    range.add({ min: 2, max: 3 });
    expect(range.range).toEqual({ min: 2, max: 3 });
    range.add({ min: 0, max: 10 });
    expect(range.range).toEqual({ min: 0, max: 10 });
    range.add({ min: 2, max: 3 });
    expect(range.range.max).toBeLessThan(10);
    expect(range.range.max).toBeGreaterThan(9);
    for (let i = 0; i < 300; ++i) range.add({ min: 2, max: 3 });
    expect(range.range.min).toBeCloseTo(2, 3);
    expect(range.range.max).toBeCloseTo(3, 3);
  });

  it('has a width without values', () => {
    const range = new AutoRange(false);
    range.add({ min: Infinity, max: -Infinity });
    expect(range.range).toEqual({ min: 0, max: 1 });
  });

  it.each([
    [5, 4.5, 5.5],
    [0, 0, 0.5],
    [0.2, 0, 0.7],
    [-2, -2.5, -1.5],
  ])('has a width for equal values: %f', (value, min, max) => {
    const range = new AutoRange(false);
    range.add({ min: value, max: value });
    expect(range.range).toEqual({ min, max });
  });

  it('has 0 in the middle of a diverging map if both signs occur', () => {
    const range = new AutoRange(true);
    range.add({ min: -1, max: 4 });
    expect(range.range).toEqual({ min: -4, max: 4 });
    const positive = new AutoRange(true);
    positive.add({ min: 990, max: 1010 });
    expect(positive.range).toEqual({ min: 990, max: 1010 });
  });
});

describe('numbers', () => {
  it.each([
    [0, '0'],
    [3.14159, '3.14'],
    [1000, '1000'],
    [998.7, '999'],
    [-0.05, '−0.0500'],
    [123456, '1.2e5'],
    [0.00012, '1.2e-4'],
  ])('%f is written as %s', (value, text) => expect(formatQuantity(value)).toBe(text));

  it('are asked for as exactly as colours can tell', () => {
    // Free fall over a metre, and the pressure below a metre of water, in 200 steps.
    expect(quantityError('speed', 1)).toBeCloseTo(4.43 / 200, 3);
    expect(quantityError('pressure', 1)).toBeCloseTo(9810 / 200, 3);
  });
});

describe('the cutting plane', () => {
  const box = new Box3(new Vector3(0, 0, 0), new Vector3(2, 4, 8));
  const isSeen = (plane: Vector4, x: number, y: number, z: number): boolean =>
    plane.x * x + plane.y * y + plane.z * z <= plane.w;

  it('crosses the box at the given position', () => {
    const plane = new Vector4();
    setClipPlane(plane, { clip: 'y', clipAt: 0.25, clipOther: false }, box);
    expect(isSeen(plane, 1, 0.9, 1)).toBe(true);
    expect(isSeen(plane, 1, 1.1, 1)).toBe(false);
    setClipPlane(plane, { clip: 'y', clipAt: 0.25, clipOther: true }, box);
    expect(isSeen(plane, 1, 0.9, 1)).toBe(false);
    expect(isSeen(plane, 1, 1.1, 1)).toBe(true);
    setClipPlane(plane, { clip: 'z', clipAt: undefined, clipOther: false }, box);
    expect(isSeen(plane, 1, 1, 3.9)).toBe(true);
    expect(isSeen(plane, 1, 1, 4.1)).toBe(false);
  });

  it('cuts nothing if it is off', () => {
    const plane = new Vector4();
    setClipPlane(plane, { clip: 'off', clipAt: 0, clipOther: false }, box);
    expect(isSeen(plane, 99, 99, 99)).toBe(true);
    setClipPlane(plane, { clip: 'x', clipAt: 0, clipOther: false }, new Box3());
    expect(isSeen(plane, 99, 99, 99)).toBe(true);
  });
});
