import { createServer } from 'node:http';
import { readFile } from 'node:fs/promises';
import type { AddressInfo } from 'node:net';
import { extname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import type { Page } from 'playwright-core';
import { build } from 'vite';
import { afterAll, beforeAll, expect, it } from 'vitest';
import { Observer } from './support/observer';
import { Server } from './support/server';
import { sharedBrowser } from './support/shared';
import { kInTime } from './support/visits';

/** The example pages of the web component, on a server of another origin. */
const kWeb = fileURLToPath(new URL('../../web/', import.meta.url));
const kFolder = join(kWeb, 'element/dist');
const kRecording = fileURLToPath(
  new URL('../golden/frame_recordings/twice.vatrec', import.meta.url),
);
const kExample = fileURLToPath(new URL('../../protocol/examples/embed.html', import.meta.url));
const kReadme = fileURLToPath(new URL('../../web/element/README.md', import.meta.url));
const kFiles: Readonly<Record<string, string>> = {
  '/twice.vatrec': kRecording,
  '/embed.html': kExample,
  '/readme.html': kReadme,
};
const kTypes: Readonly<Record<string, string>> = {
  '.html': 'text/html',
  '.js': 'text/javascript',
  '.css': 'text/css',
  '.md': 'text/html', // of which only the example is sent
};

const site = createServer((request, response) => {
  const { pathname } = new URL(request.url ?? '/', 'http://site');
  const path = kFiles[pathname] ?? join(kFolder, pathname);
  readFile(path).then(
    (content) => {
      response.setHeader('Content-Type', kTypes[extname(path)] ?? 'application/octet-stream');
      response.end(adapted(path, content));
    },
    () => response.writeHead(404).end(),
  );
});
let origin = '';
let server: Server;

/** The address of the server in the example, and that of the test's server. */
const kAddress = 'ws://127.0.0.1:8080/ws';
const liveAddress = (): string => `${server.url.replace('http', 'ws')}ws`;

/** The content of a file, with the addresses of this test in examples. */
function adapted(path: string, content: Buffer): Buffer | string {
  if (path === kExample) return String(content).replace(kAddress, liveAddress());
  if (path !== kReadme) return content;
  const [example = ''] = /(?<=^```html\n).*?(?=^```)/ms.exec(String(content)) ?? [];
  return `<!doctype html><link rel="icon" href="data:,">${example}`
    .replace('wss://vat.example/ws?session=s1', liveAddress())
    .replace('wave.vatrec', '/twice.vatrec');
}

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

/** Calls `act` with a page. Fails if the page has a problem. */
async function withPage(act: (page: Page) => Promise<void>): Promise<void> {
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
  try {
    await act(page);
    expect(problems).toEqual([]);
  } finally {
    await page.context().close();
  }
}

/** Waits until the n-th viewer shows a tick of at least `tick`. */
const shows = (page: Page, n: number, tick: number): Promise<void> =>
  expect
    .poll(() => page.evaluate((at) => Number(window.canvasOf(at)?.dataset.tick ?? -1), n), kInTime)
    .toBeGreaterThanOrEqual(tick);

it('shows a live session in the example of a page', () =>
  withPage(async (page) => {
    await page.goto(`${origin}/embed.html`);
    await shows(page, 0, 2);
  }));

it('shows the session and the recording of the example in README.md', () =>
  withPage(async (page) => {
    await page.goto(`${origin}/readme.html`);
    await shows(page, 0, 2);
    await page.locator('vat-viewer').nth(1).scrollIntoViewIfNeeded();
    await shows(page, 1, 0);
    expect(await page.getByLabel('A dam break').count()).toBe(1);
  }));

it('shows two live scenes in an article, and a recording', () =>
  withPage(async (page) => {
    await page.goto(`${origin}/example.html?server=${liveAddress()}`);
    for (const n of [0, 1]) {
      await page.locator('vat-viewer').nth(n).scrollIntoViewIfNeeded();
      await shows(page, n, 2);
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
    await shows(page, 1, 0);
    await second.evaluate((element) => element.setAttribute('src', 'ftp://host/x'));
    await expect
      .poll(() => second.getByRole('status').textContent(), kInTime)
      .toContain('must begin with ws:');
  }));
