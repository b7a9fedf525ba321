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

/** Flags of tests. They take two thirds of the time that the software GL of Chromium takes. */
export const kTestFlags = [
  '--use-angle=gl-egl', // Mesa's software GL, which keeps compiled shaders for the next page
  '--ignore-gpu-blocklist',
  // Most code of a page runs seldom in a test, so optimising it costs more time than it saves.
  '--js-flags=--no-maglev --no-turbofan',
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
export function launchChromium(more: readonly string[] = []): Promise<Browser> {
  const { args = [], ...options } = launchOptions();
  return chromium.launch({ ...options, args: [...args, ...more, '--disable-gpu-compositing'] });
}
