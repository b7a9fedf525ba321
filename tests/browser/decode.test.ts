import { execFile } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { promisify } from 'node:util';
import { expect, it } from 'vitest';

/** `vat bench codec` compares the decoders' speed. This test only runs all of them. */
it('decodes the frames of the bench in C++, in Node and in a worker of the browser', async () => {
  const program = process.env.VAT_BENCH_PROGRAM;
  if (!program) throw new Error('VAT_BENCH_PROGRAM must be the path of the built program');
  const folder = mkdtempSync(join(tmpdir(), 'vat-decode-test-'));
  try {
    const words = ['codec', '--quick', '--case', 'figure-2', '--output', folder];
    await promisify(execFile)(program, words);
    const table = JSON.parse(readFileSync(join(folder, 'decoders.json'), 'utf8')) as {
      decoder: string;
      particles: number;
      times: number;
    }[];
    const names = ['C++', 'TypeScript, Node', 'TypeScript, worker of Chromium'];
    expect(table.map(({ decoder }) => decoder)).toEqual(names);
    expect(table[0]!.times).toBeGreaterThan(10);
    for (const { particles, times } of table) {
      expect({ particles, times }).toEqual({
        particles: table[0]!.particles,
        times: table[0]!.times,
      });
    }
  } finally {
    rmSync(folder, { recursive: true });
  }
});
