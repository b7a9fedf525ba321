import type { FullPixels, Region } from './pixels';

/** Smaller differences of a channel are not visible. */
const kSeen = 24;

/** The pixels of a liquid in a picture, row by row. */
export interface Mask {
  width: number;
  height: number;
  isLiquid: boolean[];
}

/** Returns the pixels that differ between two pictures with different colours of the liquid. */
export function maskOf(first: FullPixels, second: FullPixels): Mask {
  const { width, height } = first;
  const isLiquid = Array.from({ length: width * height }, (_, i) =>
    [0, 1, 2].some((c) => Math.abs(first.data[4 * i + c]! - second.data[4 * i + c]!) > kSeen),
  );
  return { width, height, isLiquid };
}

/**
 * Returns the root mean square of the angle between drawn normals and a direction (a unit vector)
 * [degrees], over a region of a picture that is coloured by normals.
 */
export function normalDeviation(
  { width, height, data }: FullPixels,
  { left, top, right, bottom }: Region,
  [ex, ey, ez]: readonly [number, number, number],
): number {
  let sum = 0;
  let count = 0;
  for (let y = Math.ceil(top * height); y < bottom * height; ++y) {
    for (let x = Math.ceil(left * width); x < right * width; ++x) {
      const at = 4 * (y * width + x);
      const [nx, ny, nz] = [0, 1, 2].map((c) => (2 * data[at + c]!) / 255 - 1) as [
        number,
        number,
        number,
      ];
      const along = nx * ex + ny * ey + nz * ez;
      const across = Math.hypot(nx - along * ex, ny - along * ey, nz - along * ez);
      sum += Math.atan2(across, along) ** 2;
      ++count;
    }
  }
  return (Math.sqrt(sum / count) * 180) / Math.PI;
}

/** Returns the mean difference of all channels, relative to their range. */
export function meanChange({ data: a }: FullPixels, { data: b }: FullPixels): number {
  let sum = 0;
  for (let i = 0; i < a.length; ++i) if (i % 4 < 3) sum += Math.abs(a[i]! - b[i]!);
  return sum / (0.75 * a.length) / 255;
}

/** Returns the upper outline: the row of the first liquid pixel in each column, or undefined. */
export function outlineOf({ width, height, isLiquid }: Mask): (number | undefined)[] {
  return Array.from({ length: width }, (_, x) => {
    for (let y = 0; y < height; ++y) if (isLiquid[y * width + x]) return y;
    return undefined;
  });
}

/**
 * Returns the depth of the deepest dent in an outline [pixels]: its distance from its closing by a
 * line of `reach` pixels. A dent is narrower than the line. The ends of the outline do not count.
 */
export function deepestDent(outline: readonly (number | undefined)[], reach: number): number {
  const heights = outline.filter((row) => row !== undefined).map((row) => -row);
  const half = Math.floor(reach / 2);
  const filter = (values: number[], pick: (...all: number[]) => number): number[] =>
    values.map((_, x) => pick(...values.slice(Math.max(x - half, 0), x + half + 1)));
  const closed = filter(filter(heights, Math.max), Math.min);
  const depths = closed.map((height, x) => height - heights[x]!);
  return Math.max(...depths.slice(2 * half, -2 * half));
}

/** Returns the greatest difference of a diameter from the mean one, relative to it; in 36 directions. */
export function unroundness({ width, height, isLiquid }: Mask): number {
  const diameters = Array.from({ length: 36 }, (_, n) => {
    const [c, s] = [Math.cos((n * Math.PI) / 36), Math.sin((n * Math.PI) / 36)];
    let low = Infinity;
    let high = -Infinity;
    for (let y = 0; y < height; ++y) {
      for (let x = 0; x < width; ++x) {
        if (!isLiquid[y * width + x]) continue;
        const at = c * x + s * y;
        low = Math.min(low, at);
        high = Math.max(high, at);
      }
    }
    return high - low;
  });
  const mean = diameters.reduce((sum, value) => sum + value, 0) / diameters.length;
  return Math.max(...diameters.map((value) => Math.abs(value / mean - 1)));
}

/**
 * Returns the number of pixels without liquid in a lower corner of a block of liquid, a square with
 * this part of the block's width as its side, relative to the square. The greater of both corners.
 */
export function cornerGap({ width, isLiquid }: Mask, part: number): number {
  const low = Math.floor(isLiquid.lastIndexOf(true) / width);
  const extentAt = (y: number): [number, number] => {
    const row = isLiquid.slice(y * width, (y + 1) * width);
    return [row.indexOf(true), row.lastIndexOf(true)];
  };
  const [first, last] = extentAt(low);
  const side = Math.round(part * (last - first));
  // The sides of the block are inclined in perspective, but hardly within the square.
  const [left, right] = extentAt(low - side);
  const gaps = [left, right - side + 1].map((from) => {
    let count = 0;
    for (let y = low - side + 1; y <= low; ++y) {
      for (let x = from; x < from + side; ++x) if (!isLiquid[y * width + x]) ++count;
    }
    return count;
  });
  return Math.max(...gaps) / side ** 2;
}

/** Normals with a smaller vertical coordinate point down. */
const kDown = -0.4;

/** Returns the number of pixels in a region whose normals point down. */
export function downward(
  { width, height, data }: FullPixels,
  { left, top, right, bottom }: Region,
): number {
  let count = 0;
  for (let y = Math.ceil(top * height); y < bottom * height; ++y) {
    for (let x = Math.ceil(left * width); x < right * width; ++x) {
      if ((2 * data[4 * (y * width + x) + 2]!) / 255 - 1 < kDown) ++count;
    }
  }
  return count;
}
