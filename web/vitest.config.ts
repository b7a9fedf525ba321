import { resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { defineConfig } from 'vitest/config';

const web = resolve(fileURLToPath(import.meta.url), '..');
const repository = resolve(web, '..');

export default defineConfig({
  root: repository,
  resolve: {
    alias: ['three', 'vscode-json-languageservice'].map((name) => ({
      find: name,
      replacement: resolve(web, 'node_modules', name), // tests are outside web/
    })),
  },
  server: { fs: { allow: [repository] } },
  // One module cache for all files of a process: loading modules takes three quarters of the time.
  test: {
    include: ['tests/web/**/*.test.ts'],
    isolate: false,
    testTimeout: 180_000, // the limits of vitest fail on a loaded machine
    hookTimeout: 180_000,
  },
});
