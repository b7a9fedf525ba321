import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import type { Page } from 'playwright-core';
import { afterAll, expect, it } from 'vitest';
import { linked } from './support/link';
import { openPage, sharedServer } from './support/shared';
import { kInTime, Visits } from './support/visits';

/** The camera, photos, videos and links. */
const visits = new Visits();

const kRecording = fileURLToPath(
  new URL('../golden/frame_recordings/twice.vatrec', import.meta.url),
);

async function openMenu(page: Page): Promise<void> {
  await page.keyboard.press('c');
  await page.waitForSelector('#photo');
}

const files = mkdtempSync(join(tmpdir(), 'vat-camera-'));
afterAll(() => rmSync(files, { recursive: true }));

/** Clicks a button and returns the downloaded file. */
async function saved(page: Page, button: string): Promise<{ name: string; bytes: Buffer }> {
  const downloads = page.waitForEvent('download');
  await page.click(button);
  const download = await downloads;
  const name = download.suggestedFilename();
  await download.saveAs(join(files, name));
  return { name, bytes: readFileSync(join(files, name)) };
}

const kViews: [string, (x: number, y: number, z: number) => boolean][] = [
  ['4', (x, y, z) => -y > 5 * Math.hypot(x, z)], // front
  ['5', (x, y, z) => x > 5 * Math.hypot(y, z)], // side
  ['6', (x, y, z) => z > 5 * Math.hypot(x, y)], // top
  ['7', (x, y, z) => -y > x && x > 0 && z > 0], // corner
];

it('views the scene from each side by a key', async () => {
  await visits.visit('rigid-stack');
  const { page } = visits.viewer;
  for (const [key, isThere] of kViews) {
    await page.keyboard.press(key);
    const isFrom = async (): Promise<boolean> => {
      const { camera } = await linked(page);
      const [x, y, z] = [0, 1, 2].map((q) => camera[q]! - camera[q + 3]!);
      return isThere(x!, y!, z!);
    };
    await expect.poll(isFrom, kInTime).toBe(true);
  }
});

it('follows a body', async () => {
  await visits.visit('deformable-drop');
  const { observer, viewer } = visits;
  const { page } = viewer;
  await openMenu(page);
  await page.selectOption('#camera-follow', { label: 'ball' });
  await page.keyboard.press('Escape');
  const body = Number(await viewer.said('followed'));
  const distance = async (): Promise<number> => {
    const { positions } = await observer.body(body);
    const { camera } = await linked(page);
    const middle = [0, 1, 2].map(
      (q) => positions.reduce((sum, p) => sum + p[q]!, 0) / positions.length,
    );
    return Math.hypot(...middle.map((x, q) => x - camera[3 + q]!));
  };
  await expect.poll(distance, kInTime).toBeLessThan(0.01);
  await observer.request('control.step', { ticks: 12 });
  await expect.poll(distance, kInTime).toBeLessThan(0.01);
  await page.keyboard.press('f');
  expect(await viewer.said('followed')).toBe('');
});

it('shows the gestures at the first visit only', async () => {
  const first = await openPage(sharedServer.url, { deviceScaleFactor: 0.5 });
  try {
    const { page } = first;
    await first.until('#view[data-tick]');
    const hint = page.locator('#hint');
    await expect.poll(() => hint.isVisible(), kInTime).toBe(true);
    expect(await hint.locator('.mouse b').count()).toBe(3);
    await page.mouse.click(20, 20);
    await expect.poll(() => hint.isVisible(), kInTime).toBe(false);
    await page.reload();
    await first.until('#view[data-tick]');
    expect(await hint.isVisible()).toBe(false);
  } finally {
    await first.close();
  }
});

declare global {
  interface Window {
    /** The sizes of the canvas at draw calls, as "width height". */
    drawnSizes: Set<string>;
  }
}

/** Runs in the browser, before the page's own scripts. */
function watchSizes(): void {
  window.drawnSizes = new Set();
  const { drawElements } = WebGL2RenderingContext.prototype;
  WebGL2RenderingContext.prototype.drawElements = function (...args): void {
    const [, , width, height] = this.getParameter(this.VIEWPORT) as Int32Array;
    window.drawnSizes.add(`${width} ${height}`);
    drawElements.apply(this, args);
  };
}

it('saves photos that are drawn at their size', async () => {
  await visits.visit('rigid-stack', {
    viewport: { width: 800, height: 500 }, // another page, for the script
    before: (page) => page.addInitScript(watchSizes),
  });
  const { page } = visits.viewer;
  const before = await visits.viewer.stillPicture();
  await openMenu(page);
  await page.selectOption('#photo-size', { label: '3840 × 2160' });
  const { name, bytes } = await saved(page, '#photo');
  expect(name).toBe('vat-rigid-stack-0.00s.png');
  expect(bytes.toString('latin1', 1, 4)).toBe('PNG');
  expect([bytes.readUInt32BE(16), bytes.readUInt32BE(20)]).toEqual([3840, 2160]);
  expect(await page.evaluate(() => window.drawnSizes.has('3840 2160'))).toBe(true);
  await page.keyboard.press('Escape');
  expect(await visits.viewer.difference(before, await visits.viewer.stillPicture())).toBeLessThan(
    20,
  );
});

it('saves a video', async () => {
  await visits.visit('rigid-stack');
  const { observer, viewer } = visits;
  await openMenu(viewer.page);
  await viewer.page.click('#video');
  await viewer.until('#video[aria-pressed="true"]');
  for (let tick = 1; tick <= 5; ++tick) {
    await observer.request('control.step', {});
    await viewer.untilTick(tick);
    await viewer.picture(); // the recorder receives drawn frames only
  }
  const { name, bytes } = await saved(viewer.page, '#video');
  expect(name).toMatch(/^vat-rigid-stack-0\.\d\ds\.webm$/);
  expect(bytes.readUInt32BE(0)).toBe(0x1a45dfa3); // the first element of Matroska files
  expect(bytes.length).toBeGreaterThan(1000);
});

it('restores moment, camera and look of a recording from a link', async () => {
  const serve = (page: Page): Promise<unknown> =>
    page.route('**/twice.vatrec', (route) => route.fulfill({ path: kRecording }));
  const open = (address: string) =>
    openPage(address, { deviceScaleFactor: 0.5, before: serve, isUnrecorded: true });
  const first = await open(`${sharedServer.url}?recording=twice.vatrec#at=2&view=arrows:true`);
  let link: URL;
  try {
    await first.untilTick(2, 2);
    expect(await first.page.getAttribute('#replay-position', 'data-position')).toBe('2');
    expect(await first.page.textContent('#replay-play')).toBe('Play'); // paused
    await first.page.keyboard.press('6');
    const height = async (): Promise<number> => (await linked(first.page)).camera[2]!;
    const low = await height();
    await expect.poll(height, kInTime).toBeGreaterThan(1.2 * low);
    await first.page.keyboard.press('Escape');
    ({ url: link } = await linked(first.page));
  } finally {
    await first.close();
  }
  const parts = new URLSearchParams(link.hash.slice(1));
  expect(link.searchParams.get('recording')).toBe('twice.vatrec');
  expect(parts.get('at')).toBe('2');
  expect(parts.get('view')).toBe('arrows:true');
  const second = await open(link.href);
  try {
    await second.untilTick(2, 2);
    expect((await linked(second.page)).camera).toEqual(parts.get('camera')!.split(',').map(Number));
  } finally {
    await second.close();
  }
});
