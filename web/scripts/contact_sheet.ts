/**
 * Draws every catalogue scene in each look at three moments, 1280 × 720 pixels, in the built page:
 * SCENE-LOOK-N.png, and a contact sheet LOOK.jpg with a row per scene. VAT_PROGRAM names the
 * program, CHROMIUM the browser. Arguments: --output FOLDER, --look NAME, and names of scenes.
 */
import { mkdirSync, writeFileSync } from 'node:fs';
import { join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import { Observer } from '../../tests/browser/support/observer';
import { Server } from '../../tests/browser/support/server';
import { Viewer } from '../../tests/browser/support/viewer';
import { addStyle } from './style';

const kFolder = fileURLToPath(new URL('../../build/bench/pictures/', import.meta.url));
const kSize = { width: 1280, height: 720 };

/** Simulated times of the pictures [s]: the first action, the main action, and later. */
const kMoments = [0.4, 1.2, 4];
/** All catalogue scenes have ticks of 20 ms. */
const kTicksPerSecond = 50;
/** Ticks of a request, which must be answered in time. */
const kStep = 10;

/** The looks as settings of the view. */
const kLooks: Readonly<Record<string, string>> = {
  default: 'liquid:fluid,orbit:off',
  surface: 'liquid:surface,solids:skin,orbit:off',
  splats: 'liquid:splats,orbit:off',
  particles: 'liquid:particles,solids:particles,orbit:off',
};
/** A worker computes surfaces and skins during this time [ms]. */
const kSurfacesMs = 1500;

const kOnlyPicture =
  '#panel, #stage > :not(#view) { display: none !important; } body { display: block !important; } #stage { position: fixed; inset: 0; }';

const { values, positionals } = parseArgs({
  args: process.argv.slice(2).filter((word) => word !== '--' && !word.endsWith('contact_sheet.ts')),
  options: {
    output: { type: 'string', default: kFolder },
    look: { type: 'string', multiple: true, default: Object.keys(kLooks) },
  },
  allowPositionals: true,
});
for (const look of values.look) {
  if (!(look in kLooks)) throw new Error(`no look '${look}': ${Object.keys(kLooks).join(', ')}`);
}

/** Runs in the browser: draws pictures in rows, each with its name, and returns a data URL. */
async function compose(rows: { name: string; pictures: string[] }[]): Promise<string> {
  const [width, height] = [480, 270];
  const canvas = document.createElement('canvas');
  const columns = Math.max(...rows.map(({ pictures }) => pictures.length));
  [canvas.width, canvas.height] = [columns * width, rows.length * height];
  const context = canvas.getContext('2d')!;
  context.font = '16px sans-serif';
  for (const [row, { name, pictures }] of rows.entries()) {
    for (const [column, address] of pictures.entries()) {
      const image = new Image();
      image.src = address;
      await image.decode();
      context.drawImage(image, column * width, row * height, width, height);
    }
    context.fillText(name, 8, row * height + 20);
  }
  return canvas.toDataURL('image/jpeg', 0.9);
}

/** Computes without pictures, which would delay the steps. Foam results from the pictures after it. */
async function advance(observer: Observer, ticks: number): Promise<void> {
  await viewer.brake(true);
  for (let left = ticks; left > 0; left -= kStep) {
    await observer.request('control.step', { ticks: Math.min(kStep, left) });
  }
  await viewer.brake(false);
}

/** npm runs this in web/; relative paths refer to the folder of the command. */
const folder = resolve(process.env.INIT_CWD ?? '.', values.output);
mkdirSync(folder, { recursive: true });
const server = new Server();
await server.start();
const observer = await Observer.join(server.url);
await observer.request('control.pause', {});
const viewer = await Viewer.open(server.url, { viewport: kSize, colorScheme: 'light' });
const save = (name: string, address: string): void =>
  writeFileSync(join(folder, name), Buffer.from(address.split(',').pop()!, 'base64'));
const sheets = new Map(values.look.map((look) => [look, [] as Parameters<typeof compose>[0]]));

async function draw(scene: string): Promise<void> {
  await observer.request('scene.load', { scene });
  await viewer.untilScene(scene);
  for (const look of values.look) sheets.get(look)!.push({ name: scene, pictures: [] });
  let tick = 0;
  for (const [n, moment] of kMoments.entries()) {
    const next = Math.round(moment * kTicksPerSecond);
    await advance(observer, next - tick - kStep);
    await observer.request('control.step', { ticks: kStep });
    await viewer.untilTick(next, next);
    tick = next;
    for (const look of values.look) {
      await viewer.setView(kLooks[look]!);
      if (look === 'surface') await viewer.page.waitForTimeout(kSurfacesMs);
      const picture = await viewer.stillPicture();
      sheets.get(look)!.at(-1)!.pictures.push(picture);
      save(`${scene}-${look}-${n + 1}.png`, picture);
    }
  }
}

try {
  await viewer.untilTick(0);
  await addStyle(viewer.page, kOnlyPicture);
  const { scenes } = await observer.request('scene.list', {});
  const unknown = positionals.filter((name) => !scenes.some((scene) => scene.name === name));
  if (unknown.length > 0) throw new Error(`no scene ${unknown.join(', ')}`);
  for (const { name } of scenes) {
    if (positionals.length > 0 && !positionals.includes(name)) continue;
    process.stdout.write(`${name}\n`);
    await draw(name);
  }
  if (viewer.problems.length > 0) throw new Error(viewer.problems.join('\n'));
  for (const [look, rows] of sheets) {
    save(`${look}.jpg`, await (await viewer.blankPage()).evaluate(compose, rows));
  }
} finally {
  await viewer.close();
  observer.leave();
  await server.kill();
}
