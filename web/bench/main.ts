/**
 * Times the frame decoder for `vat bench codec`. It is built as the viewer is. With the arguments
 * STREAM and RESULT it decodes the stream in Node and, if there is a browser, in a worker of the
 * browser. It writes a CSV file with a row for each time.
 */
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'vite';
import { chromiumPath } from '../../tests/browser/support/chromium';
import { timesInChromium } from './chromium';
import type { DecodeTimes } from './decode_times';

const kFolder = fileURLToPath(new URL('.', import.meta.url));

async function built(entry: string, folder: string): Promise<string> {
  const name = `${entry}.mjs`;
  await build({
    configFile: false,
    logLevel: 'error',
    build: {
      target: 'es2022',
      outDir: folder,
      emptyOutDir: false,
      minify: 'esbuild',
      lib: { entry: join(kFolder, `${entry}.ts`), formats: ['es'], fileName: () => name },
      rollupOptions: { external: /^node:/ },
    },
  });
  return join(folder, name);
}

function rowsOf(decoder: string, version: string, { deltas, keys }: DecodeTimes): string {
  const row = (kind: string) => (ms: number) => `"${decoder}",${version},${kind},${ms}\n`;
  return [...deltas.map(row('delta')), ...keys.map(row('key'))].join('');
}

const [stream, result] = process.argv.slice(2);
if (!stream || !result) throw new Error('the stream and the result must be named');
const folder = mkdtempSync(join(tmpdir(), 'vat-decode-'));
try {
  const program = await built('node', folder);
  const inNode = execFileSync(process.execPath, [program, stream], { maxBuffer: 2 ** 26 });
  let rows = 'decoder,version,kind,ms\n';
  rows += rowsOf('TypeScript, Node', process.versions.node, JSON.parse(inNode.toString()));
  if (existsSync(chromiumPath())) {
    const script = readFileSync(await built('worker', folder));
    const { version, times } = await timesInChromium(script, readFileSync(stream));
    rows += rowsOf('TypeScript, worker of Chromium', version, times);
  }
  writeFileSync(result, rows);
} finally {
  rmSync(folder, { recursive: true });
}
