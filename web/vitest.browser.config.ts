import { resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { defineConfig } from 'vitest/config';

const web = resolve(fileURLToPath(import.meta.url), '..');
const repository = resolve(web, '..');

/** A file waits for events, drawing and physics in turn, so that two files fill two processors. */
const kProcesses = 2;

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
    // Few processes, each for many files: they share a browser, and loading takes long.
    pool: 'forks',
    poolOptions: { forks: { minForks: kProcesses, maxForks: kProcesses, isolate: false } },
    testTimeout: 180_000,
    hookTimeout: 180_000,
  },
});
