import { existsSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { chromium } from 'playwright-core';
import type { TestProject } from 'vitest/node';
import { launchOptions } from './chromium';
import { Server } from './server';

declare module 'vitest' {
  interface ProvidedContext {
    /** Endpoint of the Chromium process that all files share. */
    chromium: string;
    /** For each process, the page of the server that most of its files share. */
    servers: string[];
  }
}

const kPage = fileURLToPath(new URL('../../../web/dist/index.html', import.meta.url));

/** Starts the browser and the server of the whole suite. Returns the function that ends both. */
export default async function start({
  config,
  provide,
}: TestProject): Promise<() => Promise<void>> {
  if (!existsSync(kPage)) throw new Error(`no ${kPage}: type npm --prefix web run build`);
  const { maxForks = 1 } = config.poolOptions?.forks ?? {};
  const servers = Array.from(
    { length: Number(maxForks) },
    () => new Server(['--max-scenes-per-second', '1000']),
  );
  await Promise.all(servers.map((server) => server.start()));
  const browser = await chromium.launchServer(launchOptions());
  provide('chromium', browser.wsEndpoint());
  provide(
    'servers',
    servers.map(({ url }) => url),
  );
  return async () => {
    await browser.close();
    await Promise.all(servers.map((server) => server.kill()));
  };
}
