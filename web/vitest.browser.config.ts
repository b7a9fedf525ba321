import { resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { defineConfig } from 'vitest/config';

const web = resolve(fileURLToPath(import.meta.url), '..');
const repository = resolve(web, '..');

export default defineConfig({
  root: repository,
  server: { fs: { allow: [repository] } },
  resolve: {
    // The tests are outside this folder, so its packages need explicit paths.
    alias: {
      'playwright-core': resolve(web, 'node_modules/playwright-core/index.mjs'),
      vite: resolve(web, 'node_modules/vite/dist/node/index.js'),
      ws: resolve(web, 'node_modules/ws/wrapper.mjs'),
    },
  },
  test: {
    include: ['tests/browser/**/*.test.ts'],
    globalSetup: 'tests/browser/support/setup.ts',
    // One process for all files in sequence: they share a browser, and loading takes long. With two,
    // frames are late, and pictures differ.
    fileParallelism: false,
    pool: 'forks',
    poolOptions: { forks: { singleFork: true, isolate: false } },
    testTimeout: 180_000,
    hookTimeout: 180_000,
  },
});
