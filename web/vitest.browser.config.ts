import { resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { defineConfig } from 'vitest/config';

const web = resolve(fileURLToPath(import.meta.url), '..');
const repository = resolve(web, '..');

export default defineConfig({
  root: repository,
  server: { fs: { allow: [repository] } },
  resolve: {
    // The root and the tests lie outside of this folder, from where its packages are not found.
    alias: {
      'playwright-core': resolve(web, 'node_modules/playwright-core/index.mjs'),
      vite: resolve(web, 'node_modules/vite/dist/node/index.js'),
      ws: resolve(web, 'node_modules/ws/wrapper.mjs'),
    },
  },
  test: {
    include: ['tests/browser/**/*.test.ts'],
    fileParallelism: false,
    testTimeout: 180_000,
    hookTimeout: 180_000,
    // A picture may miss its moment where others use the processor; what fails twice is wrong.
    retry: 1,
  },
});
