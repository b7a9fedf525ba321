import { readFileSync, writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import type { Viewer } from './viewer';

/** A small picture: red, green and blue of each pixel, 0 to 255. */
export interface Pixels {
  width: number;
  height: number;
  data: number[];
  /** The picture as a file, in base64. */
  png: string;
}

/** A part of a picture, in coordinates from 0 to 1 from the upper left corner. */
export interface Region {
  left: number;
  top: number;
  right: number;
  bottom: number;
}

/** Small, so that rounding differences of single pixels average out. */
const kWidth = 96;

/** Returns the visible canvas, scaled down. */
export async function pixelsOf(viewer: Viewer): Promise<Pixels> {
  return scaledDown(viewer, await viewer.picture());
}

async function scaledDown(viewer: Viewer, address: string): Promise<Pixels> {
  const page = await viewer.blankPage();
  return page.evaluate(readPixels, [address, kWidth] as const);
}

/** Returns the mean red, green and blue of a region. */
export function statisticsOf(
  { width, height, data }: Omit<Pixels, 'png'>,
  { left, top, right, bottom }: Region,
): { red: number; green: number; blue: number } {
  const sums = [0, 0, 0];
  let count = 0;
  for (let y = Math.floor(top * height); y < Math.ceil(bottom * height); ++y) {
    for (let x = Math.floor(left * width); x < Math.ceil(right * width); ++x) {
      const at = 3 * (y * width + x);
      data.slice(at, at + 3).forEach((part, channel) => (sums[channel]! += part));
      ++count;
    }
  }
  const [red = 0, green = 0, blue = 0] = sums.map((sum) => sum / count);
  return { red, green, blue };
}

/**
 * Returns the mean difference of a channel, in steps of 255, from the reference picture of this
 * name. If VAT_WRITE_PICTURES is set, the picture becomes the reference.
 */
export async function differenceFromReference(viewer: Viewer, name: string): Promise<number> {
  const path = fileURLToPath(new URL(`../pictures/${name}.png`, import.meta.url));
  const now = await pixelsOf(viewer);
  if (process.env.VAT_WRITE_PICTURES) writeFileSync(path, Buffer.from(now.png, 'base64'));
  const kept = readFileSync(path).toString('base64');
  const { data } = await scaledDown(viewer, `data:image/png;base64,${kept}`);
  if (data.length !== now.data.length) throw new Error('the pictures differ in size');
  return now.data.reduce((all, value, i) => all + Math.abs(value - data[i]!), 0) / data.length;
}

/** Describes the canvas in a failed test: its data attributes, and a small picture as a data URL. */
export async function sketchOf(viewer: Viewer): Promise<string> {
  const page = await viewer.blankPage();
  const sketch = await page.evaluate(readSketch, [await viewer.picture(), kWidth] as const);
  const state = await viewer.page.locator('#view').evaluate((view) => ({ ...view.dataset }));
  return `${JSON.stringify(state)}\n${sketch}`;
}

/** Runs in the browser. */
async function readSketch([address, width]: readonly [string, number]): Promise<string> {
  const image = new Image();
  image.src = address;
  await image.decode();
  const canvas = document.createElement('canvas');
  canvas.width = width;
  canvas.height = Math.round((image.height * width) / image.width);
  canvas.getContext('2d')!.drawImage(image, 0, 0, canvas.width, canvas.height);
  return canvas.toDataURL('image/jpeg', 0.7);
}

/** Runs in the browser. */
async function readPixels([address, width]: readonly [string, number]): Promise<Pixels> {
  const image = new Image();
  image.src = address;
  await image.decode();
  const height = Math.round((image.height * width) / image.width);
  const canvas = new OffscreenCanvas(width, height);
  const context = canvas.getContext('2d');
  if (!context) throw new Error('the browser cannot draw');
  context.imageSmoothingQuality = 'high';
  context.drawImage(image, 0, 0, width, height);
  const data: number[] = [];
  context
    .getImageData(0, 0, width, height)
    .data.forEach((value, i) => void (i % 4 < 3 && data.push(value)));
  const file = await canvas.convertToBlob();
  const png = btoa(String.fromCharCode(...new Uint8Array(await file.arrayBuffer())));
  return { width, height, data, png };
}

/** A picture in full size: red, green, blue and opacity of each pixel, 0 to 255. */
export interface FullPixels {
  width: number;
  height: number;
  data: Uint8Array;
}

/** Returns the visible canvas after it is stable. */
export async function fullPixelsOf(viewer: Viewer): Promise<FullPixels> {
  const page = await viewer.blankPage();
  const { width, height, base64 } = await page.evaluate(readAll, await viewer.stillPicture());
  return { width, height, data: Uint8Array.from(Buffer.from(base64, 'base64')) };
}

/** Runs in the browser. */
async function readAll(
  address: string,
): Promise<{ width: number; height: number; base64: string }> {
  const image = new Image();
  image.src = address;
  await image.decode();
  const { width, height } = image;
  const context = new OffscreenCanvas(width, height).getContext('2d');
  if (!context) throw new Error('the browser cannot draw');
  context.drawImage(image, 0, 0);
  const { data } = context.getImageData(0, 0, width, height);
  const kBlock = 30_000;
  let text = '';
  for (let at = 0; at < data.length; at += kBlock) {
    text += String.fromCharCode(...data.subarray(at, at + kBlock));
  }
  return { width, height, base64: btoa(text) };
}
