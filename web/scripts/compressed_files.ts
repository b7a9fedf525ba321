import { readdirSync, readFileSync, statSync, writeFileSync } from 'node:fs';
import { extname, join } from 'node:path';
import { brotliCompressSync, constants, gzipSync } from 'node:zlib';
import type { Plugin } from 'vite';

/** Files of these types contain text. Pictures are compressed already. */
const kTypes = new Set(['.css', '.html', '.js', '.json', '.svg']);
/** A smaller file fits into one network packet in any encoding. */
const kLeastBytes = 1024;

/**
 * Writes the encodings `NAME.br` and `NAME.gz` beside each text file of a folder. Omits encodings
 * that are not shorter than the file.
 */
export function writeCompressed(folder: string): void {
  for (const name of readdirSync(folder)) {
    const path = join(folder, name);
    if (statSync(path).isDirectory()) {
      writeCompressed(path);
      continue;
    }
    if (!kTypes.has(extname(name))) continue;
    const content = readFileSync(path);
    if (content.length < kLeastBytes) continue;
    const params = { [constants.BROTLI_PARAM_SIZE_HINT]: content.length };
    const encodings = {
      br: brotliCompressSync(content, { params }),
      gz: gzipSync(content, { level: constants.Z_BEST_COMPRESSION }),
    };
    for (const [extension, encoded] of Object.entries(encodings)) {
      if (encoded.length < content.length) writeFileSync(`${path}.${extension}`, encoded);
    }
  }
}

/** Compresses the built files, so that the server need not compress them for each request. */
export function compressedFiles(folder: string): Plugin {
  return {
    name: 'compressed-files',
    apply: 'build',
    closeBundle: () => writeCompressed(folder),
  };
}
