/**
 * Takes the picture of the README, web/screenshot.png: the built page as the built program serves
 * it. VAT_PROGRAM names the program, CHROMIUM the browser.
 */
import { fileURLToPath } from 'node:url';
import { Observer } from '../../tests/browser/observer';
import { Server } from '../../tests/browser/server';
import { Viewer } from '../../tests/browser/viewer';

const kPicture = fileURLToPath(new URL('../screenshot.png', import.meta.url));
const kScene = 'sliding-vat-liquid';
/** By then the sliding has stirred the liquid and carried the bodies off their places. */
const kTick = 300;

const server = new Server();
await server.start();
const observer = await Observer.join(server.url);
// Stepped there and standing still: a busy machine would show fewer particles.
await observer.request('scene.load', { scene: kScene });
await observer.request('control.pause', {});
await observer.request('control.reset', {});
await observer.request('control.step', { ticks: kTick });
observer.leave();
try {
  const viewer = await Viewer.open(`${server.url}#view=liquid:fluid`, {
    viewport: { width: 1280, height: 800 },
    colorScheme: 'light',
  });
  try {
    await viewer.untilScene(kScene);
    await viewer.untilTick(kTick, kTick);
    await viewer.page.waitForTimeout(2000); // who has left is away for a while
    await viewer.page.screenshot({ path: kPicture });
  } finally {
    await viewer.close();
  }
} finally {
  await server.kill();
}
