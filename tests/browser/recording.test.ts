import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { expect, it } from 'vitest';
import { kInTime, unfold, Visits } from './support/visits';

/** A recording of frames is shown in place of the session. */
const visits = new Visits();

const kFile = fileURLToPath(new URL('../golden/frame_recordings/twice.vatrec', import.meta.url));

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

it('shows the fault of an invalid file, and the session continues', async () => {
  await visits.visit('rigid-stack');
  const { page } = visits.viewer;
  await open(readFileSync(kFile).subarray(0, 700));
  const words = 'The recording cannot be shown: the recording is incomplete';
  await expect.poll(() => page.textContent('#notices'), kInTime).toContain(words);
  expect(await page.isHidden('#replay')).toBe(true);
  expect(await page.getAttribute('#view', 'data-joined')).toBe('true');
});
