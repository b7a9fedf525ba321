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
  '--disable-gpu-compositing',
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

export function launchChromium(): Promise<Browser> {
  return chromium.launch(launchOptions());
}
