/**
 * Takes the picture of the README, web/screenshot.png: the built page as the built program serves
 * it. VAT_PROGRAM names the program, CHROMIUM the browser.
 */
import { fileURLToPath } from 'node:url';
import { Server } from '../../tests/browser/server';
import { Viewer } from '../../tests/browser/viewer';

const kPicture = fileURLToPath(new URL('../screenshot.png', import.meta.url));
const kScene = 'sliding-vat-liquid';
/** By then the sliding has stirred the liquid and carried the bodies off their places. */
const kTick = 300;

const server = new Server();
await server.start();
try {
  const viewer = await Viewer.open(server.url, { viewport: { width: 1280, height: 800 } });
  try {
    await viewer.untilScene(kScene);
    await viewer.untilTick(kTick);
    await viewer.until('#rate[data-slow="false"]'); // this machine may have been busy
    await viewer.page.screenshot({ path: kPicture });
  } finally {
    await viewer.close();
  }
} finally {
  await server.kill();
}
