import { existsSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import type { TestProject } from 'vitest/node';
import { Server } from './server';

declare module 'vitest' {
  interface ProvidedContext {
    /** The page of the server that most files share. */
    server: string;
  }
}

const kPage = fileURLToPath(new URL('../../../web/dist/index.html', import.meta.url));

/** Starts the server of the whole suite. Returns the function that ends it. */
export default async function start({ provide }: TestProject): Promise<() => Promise<void>> {
  if (!existsSync(kPage)) throw new Error(`no ${kPage}: type npm --prefix web run build`);
  const server = new Server(['--max-scenes-per-second', '1000']);
  await server.start();
  provide('server', server.url);
  return () => server.kill();
}
