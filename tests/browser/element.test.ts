import { createServer } from 'node:http';
import { readFile } from 'node:fs/promises';
import type { AddressInfo } from 'node:net';
import { extname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'vite';
import { afterAll, beforeAll, expect, it } from 'vitest';
import { Observer } from './support/observer';
import { Server } from './support/server';
import { sharedBrowser } from './support/shared';
import { kInTime } from './support/visits';

/** The example page of the web component, on a server of another origin. */
const kWeb = fileURLToPath(new URL('../../web/', import.meta.url));
const kFolder = join(kWeb, 'element/dist');
const kRecording = fileURLToPath(
  new URL('../golden/frame_recordings/twice.vatrec', import.meta.url),
);
const kTypes: Readonly<Record<string, string>> = {
  '.html': 'text/html',
  '.js': 'text/javascript',
  '.css': 'text/css',
};

const site = createServer((request, response) => {
  const { pathname } = new URL(request.url ?? '/', 'http://site');
  const path = pathname === '/twice.vatrec' ? kRecording : join(kFolder, pathname);
  readFile(path).then(
    (content) => {
      response.setHeader('Content-Type', kTypes[extname(path)] ?? 'application/octet-stream');
      response.end(content);
    },
    () => response.writeHead(404).end(),
  );
});
let origin = '';
let server: Server;

beforeAll(async () => {
  await build({ configFile: join(kWeb, 'vite.element.config.ts'), logLevel: 'error' });
  await new Promise<void>((resolve) => site.listen(0, '127.0.0.1', resolve));
  origin = `http://127.0.0.1:${(site.address() as AddressInfo).port}`;
  server = new Server(['--allow-origin', origin]);
  await server.start();
});

afterAll(async () => {
  site.close();
  await server.kill();
});

declare global {
  interface Window {
    /** Returns the canvas of the n-th viewer. */
    canvasOf(n: number): HTMLCanvasElement | null | undefined;
  }
}

it('shows two live scenes in an article, and a recording', async () => {
  const browser = await sharedBrowser();
  const page = await browser.newPage({
    viewport: { width: 500, height: 900 },
    deviceScaleFactor: 0.5,
  });
  const problems: string[] = [];
  page.on('pageerror', ({ message }) => problems.push(message));
  page.on('console', (message) => message.type() === 'error' && problems.push(message.text()));
  await page.addInitScript(() => {
    window.canvasOf = (n) =>
      document.querySelectorAll('vat-viewer')[n]?.shadowRoot?.querySelector('canvas');
  });
  const shownTick = (n: number): Promise<number> =>
    page.evaluate((at) => Number(window.canvasOf(at)?.dataset.tick ?? -1), n);
  try {
    await page.goto(`${origin}/example.html?server=${server.url.replace('http', 'ws')}ws`);
    for (const n of [0, 1]) {
      await page.locator('vat-viewer').nth(n).scrollIntoViewIfNeeded();
      await expect.poll(() => shownTick(n), kInTime).toBeGreaterThan(1);
    }
    const observer = await Observer.join(server.url);
    const { sessions } = await observer.request('session.list', {});
    const scenes = sessions.filter(({ clients }) => clients > 0).map(({ scene }) => scene);
    expect(scenes).toEqual(expect.arrayContaining(['buoyancy', 'dam-break']));
    observer.leave();
    const second = page.locator('vat-viewer').nth(1);
    await second.getByRole('button', { name: 'Pause' }).click();
    await second.getByRole('button', { name: 'Play' }).waitFor();
    await second.evaluate((element) => element.setAttribute('src', '/twice.vatrec'));
    const position = second.getByLabel('Position in the recording');
    await expect.poll(() => position.getAttribute('max'), kInTime).toBe('3');
    await expect.poll(() => shownTick(1), kInTime).toBeGreaterThanOrEqual(0);
    await second.evaluate((element) => element.setAttribute('src', 'ftp://host/x'));
    await expect
      .poll(() => second.getByRole('status').textContent(), kInTime)
      .toContain('must begin with ws:');
    expect(problems).toEqual([]);
  } finally {
    await page.context().close();
  }
});
