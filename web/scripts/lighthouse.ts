/**
 * Audits the page of the built program with Lighthouse as a desktop, and fails below the required
 * scores. The browser draws without a graphics card, so that the performance depends on other load.
 * VAT_PROGRAM names the program, CHROMIUM the browser. `--json FILE` writes the whole report.
 */
import { writeFileSync } from 'node:fs';
import { createServer } from 'node:net';
import type { AddressInfo } from 'node:net';
import { launchOptions } from '../../tests/browser/support/chromium';
import { Server } from '../../tests/browser/support/server';
import { chromium } from 'playwright-core';

/** The least scores, 0 to 100. */
const kLeast = { performance: 90, accessibility: 95, 'best-practices': 95 } as const;

interface Audit {
  title: string;
  score: number | null;
  displayValue?: string;
}

interface Report {
  categories: Record<string, { score: number | null; auditRefs: { id: string; weight: number }[] }>;
  audits: Record<string, Audit>;
}

type Lighthouse = (
  url: string,
  flags: { port: number; onlyCategories: string[]; logLevel: 'error' },
  config: object,
) => Promise<{ lhr: Report } | undefined>;

/** Returns a free port of this machine. */
async function freePort(): Promise<number> {
  const server = createServer().listen(0, '127.0.0.1');
  await new Promise((resolve) => server.once('listening', resolve));
  const { port } = server.address() as AddressInfo;
  await new Promise((resolve) => server.close(resolve));
  return port;
}

const say = (line: string): void => void process.stdout.write(`${line}\n`);

// The package is in its own folder, because it would double the installation of the viewer.
const core = new URL('../lighthouse/node_modules/lighthouse/core/', import.meta.url).href;
const { default: lighthouse } = (await import(`${core}index.js`)) as { default: Lighthouse };
const { default: desktop } = (await import(`${core}config/desktop-config.js`)) as {
  default: object;
};
const server = new Server();
await server.start();
const port = await freePort();
const options = launchOptions();
const browser = await chromium.launch({
  ...options,
  args: [...(options.args ?? []), `--remote-debugging-port=${port}`],
});
let isGood = true;
try {
  const flags = { port, onlyCategories: Object.keys(kLeast), logLevel: 'error' } as const;
  const result = await lighthouse(server.url, flags, desktop);
  if (!result) throw new Error('Lighthouse has no result');
  const { lhr } = result;
  for (const [name, least] of Object.entries(kLeast)) {
    const { score, auditRefs } = lhr.categories[name]!;
    const percent = Math.round(100 * (score ?? 0));
    isGood &&= percent >= least;
    say(`${name}: ${percent} (at least ${least})`);
    for (const { id, weight } of auditRefs) {
      const { title, score: part, displayValue = '' } = lhr.audits[id]!;
      if (part === null || part >= 0.9) continue;
      say(
        `  ${Math.round(100 * part)} ${weight > 0 ? '' : '(no weight) '}${title} ${displayValue}`,
      );
    }
  }
  const json = process.argv.indexOf('--json');
  if (json > 0) writeFileSync(process.argv[json + 1]!, JSON.stringify(lhr, undefined, 2));
} finally {
  await browser.close();
  await server.kill();
}
process.exitCode = isGood ? 0 : 1;
