import { execFile } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { promisify } from 'node:util';
import { afterAll, beforeAll, expect, it } from 'vitest';

/**
 * `vat bench codec` measures times, which depend on what else the machine does; their ratios less
 * so. Measured on a quiet machine, Node takes 1.8 times as long as C++ and Chromium's worker as
 * long as Node. What V8 does not compile takes ten times as long and more.
 */
const kMostOverNative = 6;
const kMostOverNode = 3;

const folder = mkdtempSync(join(tmpdir(), 'vat-decode-test-'));
let rows: Map<string, number>;

beforeAll(async () => {
  const program = process.env.VAT_BENCH_PROGRAM;
  if (!program) throw new Error('VAT_BENCH_PROGRAM must be the path of the built program');
  const words = ['codec', '--quick', '--case', 'dam-break-30k', '--output', folder];
  await promisify(execFile)(program, words);
  const table = JSON.parse(readFileSync(join(folder, 'decoders.json'), 'utf8')) as {
    decoder: string;
    'ms per frame': number;
  }[];
  rows = new Map(table.map((row) => [row.decoder, row['ms per frame']]));
});

afterAll(() => rmSync(folder, { recursive: true }));

function time(decoder: string): number {
  const found = rows.get(decoder);
  if (!found) throw new Error(`no time of ${decoder}`);
  return found;
}

it('takes little longer in Node than in C++', () => {
  expect(time('TypeScript, Node') / time('C++')).toBeLessThan(kMostOverNative);
});

it('takes as long in a worker of the browser as in Node', () => {
  const ratio = time('TypeScript, worker of Chromium') / time('TypeScript, Node');
  expect(ratio).toBeLessThan(kMostOverNode);
});
