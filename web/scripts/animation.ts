/**
 * Records the moving picture of the README, web/animation.webp: one period of a catalogue scene in
 * the built page. VAT_PROGRAM names the program, CHROMIUM the browser. Needs img2webp of Debian's
 * package webp (./vat packages bench).
 */
import { execFileSync } from 'node:child_process';
import { mkdtempSync, rmSync, statSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { Observer } from '../../tests/browser/support/observer';
import { Server } from '../../tests/browser/support/server';
import { Viewer } from '../../tests/browser/support/viewer';

const kTarget = fileURLToPath(new URL('../animation.webp', import.meta.url));
const kScene = 'sliding-vat-liquid';
const kMaxBytes = 3_000_000;
const kQuality = 55;
/** Ticks of 20 ms. The bodies have fallen into the liquid before the first picture. */
const kFirstTick = 200;
/** The vat's motion has a period of 2 s. */
const kTicks = 100;
const kTicksPerPicture = 3;

const folder = mkdtempSync(join(tmpdir(), 'vat-animation-'));
const server = new Server();
await server.start();
const observer = await Observer.join(server.url);
await observer.request('scene.load', { scene: kScene });
await observer.request('control.pause', {});
await observer.request('control.reset', {});
for (let tick = 0; tick < kFirstTick; tick += 10)
  await observer.request('control.step', { ticks: 10 });
const viewer = await Viewer.open(`${server.url}#view=liquid:fluid`, {
  viewport: { width: 1000, height: 460 },
  colorScheme: 'light',
});
try {
  await viewer.untilScene(kScene);
  const pictures: string[] = [];
  for (let tick = kFirstTick; tick < kFirstTick + kTicks; tick += kTicksPerPicture) {
    await viewer.untilTick(tick, tick);
    const address = await viewer.stillPicture();
    const file = join(folder, `${tick}.png`);
    writeFileSync(file, Buffer.from(address.slice(address.indexOf(',') + 1), 'base64'));
    pictures.push(file);
    await observer.request('control.step', { ticks: kTicksPerPicture });
  }
  const frame = ['-d', String(kTicksPerPicture * 20), '-lossy', '-q', String(kQuality), '-m', '6'];
  execFileSync('img2webp', [
    ...['-loop', '0', '-min_size'],
    ...pictures.flatMap((file) => [...frame, file]),
    ...['-o', kTarget],
  ]);
  const bytes = statSync(kTarget).size;
  if (bytes > kMaxBytes) throw new Error(`${kTarget} has ${bytes} bytes, limit ${kMaxBytes}`);
} finally {
  await viewer.close();
  observer.leave();
  await server.kill();
  rmSync(folder, { recursive: true });
}
