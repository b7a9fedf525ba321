import { readdirSync, readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { FrameDecoder } from '../../web/client/index';

const kFolder = fileURLToPath(new URL('../golden/frames', import.meta.url));

export interface GoldenBlock {
  body: number;
  kind: 'liquid' | 'deformable' | 'rigid' | 'vat';
  numbers?: number[];
  grid_positions?: number[];
  attributes?: number[][];
  place?: number[];
  orientation?: number[];
  orientation_bits?: number;
}

/** The expected content of a frame after earlier frames are decoded, from the `.json` file. */
export interface GoldenFrame {
  after: string[];
  header: Record<string, number | boolean | number[]>;
  blocks: GoldenBlock[];
}

/** An entry of bad.json: a valid frame, its damage, and the expected error. */
export interface BadFrame {
  name: string;
  after: string[];
  base: string;
  keep?: number;
  append?: string;
  patch?: { offset: number; bytes: string };
  error: string;
}

/** Names of the valid frames without extension. */
export function goldenNames(): string[] {
  return readdirSync(kFolder)
    .filter((file) => file.endsWith('.bin'))
    .map((file) => file.slice(0, -'.bin'.length));
}

export function goldenBytes(name: string): ArrayBuffer {
  return toArrayBuffer(readFileSync(`${kFolder}/${name}.bin`));
}

export function goldenFrame(name: string): GoldenFrame {
  return JSON.parse(readFileSync(`${kFolder}/${name}.json`, 'utf8')) as GoldenFrame;
}

/** Returns a decoder that has decoded these frames. */
export function decoderAfter(names: string[]): FrameDecoder {
  const decoder = new FrameDecoder();
  for (const name of names) decoder.decode(goldenBytes(name));
  return decoder;
}

export function badFrames(): BadFrame[] {
  return JSON.parse(readFileSync(`${kFolder}/bad.json`, 'utf8')) as BadFrame[];
}

export function damagedBytes({ base, keep, append = '', patch }: BadFrame): ArrayBuffer {
  const whole = readFileSync(`${kFolder}/${base}.bin`);
  const bytes = Buffer.concat([whole.subarray(0, keep), Buffer.from(append, 'hex')]);
  if (patch) Buffer.from(patch.bytes, 'hex').copy(bytes, patch.offset);
  return toArrayBuffer(bytes);
}

function toArrayBuffer(bytes: Buffer): ArrayBuffer {
  return new Uint8Array(bytes).buffer;
}
