import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { expect, it } from 'vitest';
import { program } from './support/server';
import { kInTime, unfold, Visits } from './support/visits';

/** A recording of frames is shown in place of the session. */
const visits = new Visits();

const kFile = fileURLToPath(new URL('../golden/frame_recordings/twice.vatrec', import.meta.url));

/** The size of a recording in a notebook. `@` is the page in base64. */
const kFrame = '<iframe width="700" height="400" src="data:text/html;base64,@"></iframe>';

const kSmall = { viewport: { width: 720, height: 420 }, deviceScaleFactor: 0.5 };

async function open(buffer: Buffer): Promise<void> {
  await unfold(visits.viewer, 'kept-details');
  await visits.viewer.page.setInputFiles('#recording-input', {
    name: 'twice.vatrec',
    mimeType: 'application/octet-stream',
    buffer,
  });
}

it('plays a file, seeks, and returns to the session', async () => {
  await visits.visit('rigid-stack');
  const { page } = visits.viewer;
  await open(readFileSync(kFile));
  await page.waitForSelector('#replay:not([hidden])');
  await visits.viewer.untilScene('twice');
  expect(await page.textContent('#connection-text')).toBe('Recording');
  expect(await page.isDisabled('#scene')).toBe(true);
  expect(await page.isDisabled('#share-open')).toBe(true);
  await page.click('#replay-play');
  const slider = page.locator('#replay-position');
  expect(await slider.getAttribute('max')).toBe('3');
  await slider.fill('2');
  await visits.viewer.untilTick(2, 2);
  expect(await page.textContent('#replay-time')).toBe('0.04 s of 0.06 s');
  await page.click('#replay-leave');
  await page.waitForSelector('#replay', { state: 'hidden' });
  await visits.viewer.untilScene('rigid-stack');
  expect(await page.isDisabled('#share-open')).toBe(false);
});

it.each(['page', 'frame of a notebook'])('plays an exported recording as a %s', async (place) => {
  await visits.visit('rigid-stack');
  const folder = mkdtempSync(join(tmpdir(), 'vat-export-'));
  const file = join(folder, 'twice.html');
  execFileSync(program(), ['export', kFile, '--html', file], { stdio: 'ignore' });
  const page = await visits.viewer.page.context().browser()!.newPage(kSmall);
  try {
    const data = readFileSync(file).toString('base64');
    if (place === 'page') await page.goto(pathToFileURL(file).href);
    else await page.setContent(kFrame.replace('@', data));
    const player = place === 'page' ? page.mainFrame() : page.frames()[1]!;
    await player.waitForSelector('#view[data-tick="3"]', kInTime);
    expect(await player.textContent('#replay')).toContain('of 0.06 s');
    const picture = (await player.locator('#view').boundingBox())!;
    const bar = (await player.locator('#replay').boundingBox())!;
    expect(picture.height).toBeGreaterThan(bar.height);
    expect(picture.y + picture.height).toBeLessThanOrEqual(bar.y);
  } finally {
    await page.close();
    rmSync(folder, { recursive: true });
  }
});

it('shows the fault of an invalid file, and the session continues', async () => {
  await visits.visit('rigid-stack');
  const { page } = visits.viewer;
  await open(readFileSync(kFile).subarray(0, 700));
  const words = 'The recording cannot be shown: the recording is incomplete';
  await expect.poll(() => page.textContent('#notices'), kInTime).toContain(words);
  expect(await page.isHidden('#replay')).toBe(true);
  expect(await page.getAttribute('#view', 'data-joined')).toBe('true');
});
