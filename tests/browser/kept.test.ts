import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import type { Locator } from 'playwright-core';
import { afterAll, beforeEach, expect, it } from 'vitest';
import { Server } from './support/server';
import { kInTime, unfold, Visits } from './support/visits';

/** Saved states and scenes, recordings and replays. */
const data = mkdtempSync(join(tmpdir(), 'vat-kept-'));
afterAll(() => rmSync(data, { recursive: true })); // after the server has ended
const visits = new Visits(new Server(['--data', data]));

beforeEach(async () => {
  await visits.visit('rigid-stack');
  await unfold(visits.viewer, 'kept-details');
});

async function save(list: string, name: string): Promise<void> {
  await visits.viewer.page.fill(`#${list}-name`, name);
  await visits.viewer.page.click(`#${list}-keep`);
  await visits.viewer.page.waitForSelector(`#${list} li[data-name="${name}"]`);
}

/** Presses the button to confirm, and a first time before if the first press has expired. */
async function pressTwice(remove: Locator): Promise<void> {
  await remove.evaluate((button: HTMLButtonElement) => {
    if (button.dataset.armed !== 'true') button.click();
    button.click();
  });
}

it('restores a saved state, and deletes it at the second click', async () => {
  await visits.observer.request('control.step', { ticks: 20 });
  await save('states', 'before the fall');
  const { hash } = await visits.observer.request('session.hash', {});
  await visits.observer.request('control.step', { ticks: 30 });
  await visits.viewer.untilTick(50, 50);
  await visits.viewer.page.click('#states li[data-name="before the fall"] >> text=Go back');
  await visits.viewer.untilTick(20, 20);
  expect((await visits.observer.request('session.hash', {})).hash).toBe(hash);
  const remove = visits.viewer.page.locator('#states li button[aria-label^="Delete"]');
  const states = async () => (await visits.observer.request('session.saves', {})).states;
  await remove.click();
  expect(await states()).toHaveLength(1);
  await pressTwice(remove);
  await expect.poll(states, kInTime).toEqual([]);
  await visits.viewer.page.waitForSelector('#states .none');
});

it('saves a scene for all, shows it among the scenes, and deletes it', async () => {
  await save('own-scenes', 'my stack');
  await visits.observer.request('scene.load', { scene: 'dam-break' });
  await visits.viewer.untilScene('dam-break');
  await visits.viewer.page.selectOption('#scene', 'my stack');
  await visits.viewer.page.waitForFunction(
    () => document.getElementById('view')?.dataset.scene !== 'dam-break',
  );
  await pressTwice(visits.viewer.page.locator('#own-scenes li button[aria-label^="Delete"]'));
  await visits.viewer.page.waitForSelector('#own-scenes .none');
  const { scenes } = await visits.observer.request('scene.list', {});
  expect(scenes.map(({ name }) => name)).not.toContain('my stack');
});

/** A session with a past of ten seconds, in which Ann grabbed a body. */
async function live(): Promise<void> {
  await visits.observer.request('participant.rename', { name: 'Ann' });
  const { bodies } = await visits.observer.request('state.query', {});
  const held = bodies.find(({ kind }) => kind === 'rigid')!;
  const [x, y, z] = held.positions[0]!;
  await visits.observer.request('control.step', { ticks: 100 });
  const { grab } = await visits.observer.request('grab.start', {
    body: held.body,
    particle: 0,
    target: [x, y, z + 0.1],
  });
  await visits.observer.request('control.step', { ticks: 100 });
  await visits.observer.request('grab.end', { grab });
  await visits.observer.request('control.step', { ticks: 300 });
}

const position = async (): Promise<number> =>
  Number(await visits.viewer.page.getAttribute('#replay-position', 'data-position'));

async function seek(share: number): Promise<void> {
  await visits.viewer.page
    .locator('#replay-position')
    .evaluate((slider: HTMLInputElement, part) => {
      slider.valueAsNumber = Math.round(Number(slider.max) * part);
      slider.dispatchEvent(new Event('input', { bubbles: true }));
      slider.dispatchEvent(new Event('change', { bubbles: true }));
    }, share);
}

it('replays a session: seeks, plays, lists the participants, and returns', async () => {
  await live();
  await visits.viewer.page.click('#recording-watch');
  await visits.viewer.page.waitForSelector('#replay:not([hidden])');
  expect(new URL(visits.viewer.page.url()).searchParams.get('session')).toMatch(/^r\d+$/);
  expect(await visits.viewer.page.isDisabled('#scene')).toBe(true);
  expect(await visits.viewer.page.isDisabled('#reset')).toBe(true);
  const end = Number(await visits.viewer.page.getAttribute('#replay-position', 'max'));
  expect(end).toBeGreaterThanOrEqual(500);
  await seek(0);
  await expect.poll(position, kInTime).toBeLessThan(10);
  await seek(1 - 350 / end); // Ann grabs a body there
  await visits.viewer.page.waitForSelector('#replay-people li:has-text("Ann holds")');
  const before = await position();
  await visits.viewer.page.click('#replay-play');
  await expect.poll(position, kInTime).toBeGreaterThan(before + 10);
  await seek(1);
  await visits.viewer.page.waitForFunction(
    () => document.getElementById('replay-time')?.textContent?.match(/^(.*) of \1$/) !== null,
  );
  await visits.viewer.page.click('#replay-leave');
  await visits.viewer.page.waitForSelector('#replay', { state: 'hidden' });
  await visits.viewer.until('#view[data-tick="500"]');
  expect(await visits.viewer.page.isDisabled('#scene')).toBe(false);
});

it('downloads a recording, and shows it when it is opened as a file', async () => {
  await live();
  const download = visits.viewer.page.waitForEvent('download');
  await visits.viewer.page.click('#recording-export');
  const path = join(data, 'mine.vatrec');
  await (await download).saveAs(path);
  expect(readFileSync(path).subarray(0, 7).toString()).toBe('vat.rec');
  await visits.viewer.page.setInputFiles('#recording-input', {
    name: 'mine.vatrec',
    mimeType: 'application/octet-stream',
    buffer: readFileSync(path),
  });
  await visits.viewer.page.waitForSelector('#replay:not([hidden])');
  await seek(0.5);
  await expect.poll(position, kInTime).toBeGreaterThan(100);
});

it('shows the fault of a file that is not a recording', async () => {
  await visits.viewer.page.setInputFiles('#recording-input', {
    name: 'broken.vatrec',
    mimeType: 'application/octet-stream',
    buffer: Buffer.from('no recording'),
  });
  await visits.viewer.until('#notices li[data-level="error"]');
  expect(await visits.viewer.page.textContent('#recording-progress')).toBe('');
  expect(await visits.viewer.page.isVisible('#replay')).toBe(false);
});
