import { fileURLToPath } from 'node:url';
import { defineConfig } from 'vite';

const folder = (name: string) => fileURLToPath(new URL(`client/${name}`, import.meta.url));

// Builds the package vat-client as one module. tsc writes its types.
export default defineConfig({
  root: folder('.'),
  build: {
    outDir: folder('dist'),
    emptyOutDir: true,
    target: 'es2022',
    minify: false,
    lib: { entry: folder('index.ts'), formats: ['es'], fileName: 'index' },
  },
});
