import { existsSync } from 'node:fs';
import { chromium } from 'playwright-core';
import type { Browser, LaunchOptions } from 'playwright-core';

const kFlags = [
  '--headless',
  '--no-sandbox',
  '--disable-quic',
  '--no-first-run',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
  '--use-gl=angle',
  '--use-angle=swiftshader',
  '--enable-unsafe-swiftshader',
];

/** Limit of every wait [ms]. Only a fault reaches it, also on a slow, busy machine. */
export const kDeadlineMs = 120_000;

/** Returns the path of the browser. */
export function chromiumPath(): string {
  return process.env.CHROMIUM ?? '/usr/bin/chromium-headless-shell';
}

/** Returns the launch options of Chromium. */
export function launchOptions(): LaunchOptions {
  const executablePath = chromiumPath();
  if (!existsSync(executablePath)) throw new Error(`no browser at ${executablePath}; set CHROMIUM`);
  return { executablePath, args: kFlags, timeout: kDeadlineMs };
}

/**
 * Starts Chromium. It composes pages without the software GL, which makes screenshots faster but
 * blocks the page for longer.
 */
export function launchChromium(): Promise<Browser> {
  const { args = [], ...options } = launchOptions();
  return chromium.launch({ ...options, args: [...args, '--disable-gpu-compositing'] });
}
