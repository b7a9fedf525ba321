import { readdirSync, readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';

const kFolder = fileURLToPath(new URL('../golden/frames', import.meta.url));

export interface GoldenBlock {
  body: number;
  kind: 'liquid' | 'deformable' | 'rigid' | 'vat';
  grid_positions?: number[];
  position?: number[];
  orientation?: number[];
}

/** What a frame's bytes stand for, as the `.json` beside them says. */
export interface GoldenFrame {
  header: Record<string, number | boolean | number[]>;
  blocks: GoldenBlock[];
}

/** One entry of bad.json: a good frame, the damage done to it, the reason to refuse it. */
export interface BadFrame {
  name: string;
  base: string;
  keep?: number;
  append?: string;
  patch?: { offset: number; bytes: string };
  error: string;
}

/** Names of the good frames, without ending. */
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

export function badFrames(): BadFrame[] {
  return JSON.parse(readFileSync(`${kFolder}/bad.json`, 'utf8')) as BadFrame[];
}

export function damagedBytes({ base, keep, append = '', patch }: BadFrame): ArrayBuffer {
  const whole = readFileSync(`${kFolder}/${base}`);
  const bytes = Buffer.concat([whole.subarray(0, keep), Buffer.from(append, 'hex')]);
  if (patch) Buffer.from(patch.bytes, 'hex').copy(bytes, patch.offset);
  if (bytes.equals(whole)) throw new Error('bad.json describes no damage');
  return toArrayBuffer(bytes);
}

function toArrayBuffer(bytes: Buffer): ArrayBuffer {
  return new Uint8Array(bytes).buffer;
}
