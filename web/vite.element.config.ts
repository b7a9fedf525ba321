import { fileURLToPath } from 'node:url';
import { defineConfig } from 'vite';

const folder = (name: string): string => fileURLToPath(new URL(`element/${name}`, import.meta.url));

/** Builds the package vat-viewer, and its example page with the component. */
export default defineConfig({
  root: folder('.'),
  base: './',
  worker: { format: 'es' },
  build: {
    outDir: folder('dist'),
    emptyOutDir: true,
    target: 'es2022',
    chunkSizeWarningLimit: 900,
    rollupOptions: {
      input: { example: folder('example.html'), 'vat-viewer': folder('vat_viewer.ts') },
      preserveEntrySignatures: 'strict',
      output: {
        entryFileNames: ({ name }) =>
          name === 'vat-viewer' ? 'vat-viewer.js' : 'assets/[name]-[hash].js',
      },
    },
  },
});
