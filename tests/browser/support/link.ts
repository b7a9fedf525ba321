import type { Page } from 'playwright-core';

/** The link of the share dialog. */
export interface Link {
  url: URL;
  /** Position and target of the camera. */
  camera: number[];
  /** The position in a recording. */
  at: string | null;
}

/** Opens the share dialog, reads its link, and closes the dialog. */
export async function linked(page: Page): Promise<Link> {
  await page.keyboard.press('l');
  await page.waitForSelector('#share[open]');
  const url = new URL(await page.inputValue('#share-link'));
  await page.keyboard.press('Escape');
  const parts = new URLSearchParams(url.hash.slice(1));
  return { camera: parts.get('camera')!.split(',').map(Number), at: parts.get('at'), url };
}
