import { chromium } from 'playwright-core';
import type { Browser } from 'playwright-core';
import { inject } from 'vitest';
import type { Host } from './server';
import { Viewer } from './viewer';
import type { Look } from './viewer';

let browser: Promise<Browser> | undefined;

/** The Chromium process of the whole suite. */
export function sharedBrowser(): Promise<Browser> {
  browser ??= chromium.connect(inject('chromium'));
  return browser;
}

/** The server of this process. Tests do not end it. */
export const sharedServer: Host = {
  url: inject('servers')[Number(process.env.VITEST_POOL_ID) - 1]!,
  start: () => Promise.resolve(),
  kill: () => Promise.resolve(),
};

/** A new page with a separate profile. */
export async function openPage(url: string, look: Look = {}): Promise<Viewer> {
  return Viewer.open(url, look, await sharedBrowser());
}
