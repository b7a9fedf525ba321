import { fileURLToPath } from 'node:url';
import { defineConfig } from 'vite';
import { exportPage, inlineWorkers } from './scripts/export_page';
import { plainShaders } from './scripts/plain_shaders';

const path = (name: string): string => fileURLToPath(new URL(name, import.meta.url));
const kBuilt = path('dist/export');

/** Builds the page of `vat export`: one program with its workers and styles. */
export default defineConfig({
  root: path('viewer'),
  base: './',
  worker: { format: 'iife', plugins: () => [inlineWorkers()] },
  build: {
    outDir: kBuilt,
    emptyOutDir: true,
    copyPublicDir: false,
    target: 'es2022',
    minify: 'esbuild',
    reportCompressedSize: false,
    lib: {
      entry: path('viewer/exported/player.ts'),
      formats: ['iife'],
      name: 'vatPlayer',
      fileName: () => 'player.js',
    },
  },
  plugins: [plainShaders(), inlineWorkers(), exportPage(kBuilt, path('viewer/exported/loader.ts'))],
});
