/**
 * Takes the pictures of the scene gallery, viewer/scenes/NAME.webp: each catalogue scene after some
 * time, in the built page. VAT_PROGRAM names the program, CHROMIUM the browser. Arguments select
 * scenes by name.
 */
import { mkdirSync, writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { Observer } from '../../tests/browser/support/observer';
import { Server } from '../../tests/browser/support/server';
import { Viewer } from '../../tests/browser/support/viewer';
import { addStyle } from './style';
import { compress } from './webp';

const kFolder = fileURLToPath(new URL('../viewer/scenes/', import.meta.url));
const kSize = { width: 384, height: 240 };
/** Simulated time after which scenes show their subject [s]. */
const kSeconds = 1;
const kMostBytes = 10_000;

/** The page's panel would cover the width of a phone. */
const kOnlyPicture =
  '#panel, #stage > :not(#view) { display: none !important; } body { display: block !important; } #stage { position: fixed; inset: 0; }';

mkdirSync(kFolder, { recursive: true });
const server = new Server();
await server.start();
const observer = await Observer.join(server.url);
await observer.request('control.pause', {});
const viewer = await Viewer.open(`${server.url}#view=liquid:fluid`, { viewport: kSize });
await addStyle(viewer.page, kOnlyPicture);
try {
  const chosen = process.argv.slice(2).filter((word) => !word.includes('/') && word !== '--');
  const { scenes } = await observer.request('scene.list', {});
  for (const { name } of scenes) {
    if (chosen.length > 0 && !chosen.includes(name)) continue;
    await observer.request('scene.load', { scene: name });
    for (let done = 0; done < kSeconds * 50; done += 10) {
      await observer.request('control.step', { ticks: 10 });
    }
    await viewer.untilScene(name);
    await viewer.untilTick(kSeconds * 50);
    // The first picture of a scene waits for its shaders.
    const picture = await viewer.stillPicture();
    const blank = await viewer.blankPage();
    const base64 = await blank.evaluate(compress, [picture, kMostBytes] as const);
    writeFileSync(`${kFolder}${name}.webp`, Buffer.from(base64, 'base64'));
  }
} finally {
  await viewer.close();
  observer.leave();
  await server.kill();
}
