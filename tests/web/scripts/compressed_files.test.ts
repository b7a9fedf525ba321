import { mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { brotliDecompressSync, gunzipSync } from 'node:zlib';
import { afterEach, expect, it } from 'vitest';
import { writeCompressed } from '../../../web/scripts/compressed_files';

const folder = mkdtempSync(join(tmpdir(), 'vat-compressed-'));
afterEach(() => rmSync(folder, { recursive: true }));

it('writes both encodings of text files that become shorter', () => {
  const text = 'a line of text\n'.repeat(100);
  mkdirSync(join(folder, 'assets'));
  writeFileSync(join(folder, 'assets/long.js'), text);
  writeFileSync(join(folder, 'short.js'), 'x'.repeat(1023));
  writeFileSync(join(folder, 'picture.webp'), text);
  writeCompressed(folder);
  expect(readdirSync(folder).sort()).toEqual(['assets', 'picture.webp', 'short.js']);
  expect(readdirSync(join(folder, 'assets')).sort()).toEqual([
    'long.js',
    'long.js.br',
    'long.js.gz',
  ]);
  const read = (name: string): Buffer => readFileSync(join(folder, 'assets', name));
  expect(brotliDecompressSync(read('long.js.br')).toString()).toBe(text);
  expect(gunzipSync(read('long.js.gz')).toString()).toBe(text);
});
