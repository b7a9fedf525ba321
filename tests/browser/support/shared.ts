import type { Browser } from 'playwright-core';
import { inject } from 'vitest';
import { kTestFlags, launchChromium } from './chromium';
import type { Host } from './server';
import { Viewer } from './viewer';
import type { Look } from './viewer';

let browser: Promise<Browser> | undefined;

/** The Chromium process of the whole suite. It ends with the process of the tests. */
export function sharedBrowser(): Promise<Browser> {
  browser ??= launchChromium(kTestFlags);
  return browser;
}

/** The server of the whole suite. Tests do not end it. */
export const sharedServer: Host = {
  url: inject('server'),
  start: () => Promise.resolve(),
  kill: () => Promise.resolve(),
};

/** A new page with a separate profile. */
export async function openPage(url: string, look: Look = {}): Promise<Viewer> {
  return Viewer.open(url, look, await sharedBrowser());
}
