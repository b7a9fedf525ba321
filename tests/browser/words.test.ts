import { spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { afterEach, expect, it } from 'vitest';
import { Observer } from './support/observer';
import { kAdminToken, Server } from './support/server';
import { openPage, sharedServer } from './support/shared';
import type { Look, Viewer } from './support/viewer';
import { says } from './support/visits';

/** Messages of the page about faults of itself, the browser or the server's files. */
const pages: Viewer[] = [];

afterEach(async () => {
  for (const page of pages.splice(0)) await page.close();
});

async function open(look: Look = {}, url = sharedServer.url): Promise<Viewer> {
  const page = await openPage(url, { deviceScaleFactor: 0.5, ...look });
  page.serverIsAway = true; // failures appear on the browser's console
  pages.push(page);
  return page;
}

it('shows that the browser has no WebGL', async () => {
  const page = await open({
    before: (page) =>
      page.addInitScript(() => {
        HTMLCanvasElement.prototype.getContext = () => null;
      }),
  });
  await says(page, 'obstacle', 'WebGL 2');
});

it('shows that a part of the page was not loaded', async () => {
  const page = await open({
    before: (page) => page.route('**/stream.worker*.js', (route) => route.abort()),
  });
  await says(page, 'obstacle', 'Reload the page');
});

/** A recording whose hash at position 12 differs from the simulation's. */
function differingRecording(): Buffer {
  const script = new URL('../protocol/scripts/replays.jsonl', import.meta.url);
  const calls = readFileSync(script, 'utf8')
    .split('\n')
    .filter((line) => line.includes('"recording.import"') && !line.includes('"error"'))
    .map((line) => JSON.parse(line) as { params: { size: number; data: string } });
  const whole = calls.map(({ params }) => Buffer.from(params.data, 'base64'));
  const found = whole.filter((bytes, n) => bytes.length === calls[n]!.params.size).pop();
  if (!found) throw new Error('the script has no whole recording');
  return found;
}

it('shows the tick at which a replay differs from its recording, and the next action', async () => {
  const page = await open();
  await page.until('#connection[data-state="open"]');
  await page.page.setInputFiles('#recording-input', {
    name: 'differs.vatrec',
    mimeType: 'application/octet-stream',
    buffer: differingRecording(),
  });
  await page.page.waitForSelector('#replay:not([hidden])');
  await page.page.focus('#replay-position');
  await page.page.keyboard.press('End');
  await says(page, 'replay-words', 'the replay differs from the recording');
  await says(page, 'replay-words', 'Use the time line to go to another position');
  expect(await page.page.isVisible('#replay-mark')).toBe(true);
  await page.page.keyboard.press('Home');
  await page.until('#replay-words[data-diverged="false"]');
});

it('shows that a server without a data folder records nothing, and the option', async () => {
  const page = await open();
  await page.until('#connection[data-state="open"]');
  await page.page.click('#kept-details > summary');
  await says(page, 'recording-note', 'does not record sessions. To record, start it with --data');
  expect(await page.page.isDisabled('#recording-watch')).toBe(true);
});

it('shows that the page is slow while the session plays, and shows all particles when it pauses', async () => {
  const observer = await Observer.join(sharedServer.url);
  await observer.request('scene.load', { scene: 'dam-break' });
  await observer.request('control.play', {});
  const page = await open({
    before: (page) =>
      page.addInitScript(() => {
        // The page gets two of its fifteen animation frames per second: acknowledgements are late
        // by 0.25 s on average, and the server tolerates 0.1 s.
        const next = window.requestAnimationFrame.bind(window);
        const after = (frames: number, callback: FrameRequestCallback): number =>
          next(frames === 0 ? callback : () => after(frames - 1, callback));
        window.requestAnimationFrame = (callback) => after(6, callback);
      }),
  });
  await page.until('#connection[data-slow="true"]');
  await says(page, 'connection-text', 'Slow: ');
  await page.page.click('#play');
  await page.until('#play[data-playing="false"]');
  await page.until('#connection[data-slow="false"]');
  await says(page, 'quality', 'every frame');
  observer.leave();
});

/** Changes a file of the server, as another version could have. */
function alter(file: string, command: string): void {
  const program =
    'import sqlite3, sys; c = sqlite3.connect(sys.argv[1]); c.execute(sys.argv[2]); c.commit()';
  const { status, stderr } = spawnSync('python3', ['-c', program, file, command]);
  if (status !== 0) throw new Error(stderr.toString());
}

it('shows that a session was restored with other bits, and continues after a reset', async () => {
  const data = mkdtempSync(join(tmpdir(), 'vat-words-'));
  const server = new Server(['--data', data, '--scene', 'rigid-stack']);
  try {
    await server.start();
    const page = await open({}, server.url);
    await page.untilTick(5);
    const observer = await Observer.join(server.url);
    await observer.request('access.enter', { token: kAdminToken });
    await observer.request('server.drain', { seconds: 0 });
    await server.ended();
    alter(join(data, 'checkpoints.db'), 'DELETE FROM checkpoints');
    alter(join(data, 'vat.db'), 'UPDATE sessions SET hash = hash + 1');
    await server.start();
    await says(page, 'notices', 'differs from its log and is paused');
    await page.page.click('#reset');
    await page.untilTick(0, 0);
    await page.page.click('#play');
    await page.untilTick(5);
    observer.leave();
  } finally {
    await server.kill();
    rmSync(data, { recursive: true });
  }
});
