import { resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { defineConfig } from 'vitest/config';

const web = resolve(fileURLToPath(import.meta.url), '..');
const repository = resolve(web, '..');

export default defineConfig({
  root: repository,
  resolve: { alias: { three: resolve(web, 'node_modules/three') } }, // tests are outside web/
  server: { fs: { allow: [repository] } },
  test: { include: ['tests/web/**/*.test.ts'] },
});
