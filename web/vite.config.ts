import { fileURLToPath } from 'node:url';
import { defineConfig } from 'vite';
import { compressedFiles } from './scripts/compressed_files';
import { plainShaders } from './scripts/plain_shaders';

const server = process.env.VAT_SERVER ?? 'http://127.0.0.1:8080';

/** Returns the path of a folder of the repository. */
const above = (folder: string): string => fileURLToPath(new URL(`../${folder}`, import.meta.url));

const kBuilt = fileURLToPath(new URL('dist', import.meta.url));

export default defineConfig({
  root: fileURLToPath(new URL('viewer', import.meta.url)),
  base: './',
  worker: { format: 'es' },
  build: {
    outDir: kBuilt,
    emptyOutDir: true,
    target: 'es2022',
    assetsInlineLimit: 0,
    chunkSizeWarningLimit: 900,
  },
  plugins: [plainShaders(), compressedFiles(kBuilt)],
  // `npm run dev` serves the page and connects to a running server.
  server: {
    proxy: { '/ws': { target: server, ws: true } },
    fs: { allow: ['web', 'protocol/scenes'].map(above) },
  },
});
