/**
 * Takes the pictures of web/README.md, pictures/NAME.webp, in the built page of the built program.
 * VAT_PROGRAM names the program, CHROMIUM the browser. Arguments select pictures by name.
 */
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { Observer } from '../../tests/browser/support/observer';
import { Server } from '../../tests/browser/support/server';
import { Viewer } from '../../tests/browser/support/viewer';
import type { Look } from '../../tests/browser/support/viewer';
import { addStyle } from './style';
import { compress } from './webp';

const kFolder = fileURLToPath(new URL('../pictures/', import.meta.url));
const kMostBytes = 40_000;
/** Ticks of a request, which must be answered in time. */
const kStep = 10;

const kDesktop: Look = { viewport: { width: 960, height: 600 } };
const kPhone: Look = { viewport: { width: 390, height: 780 }, hasTouch: true, isMobile: true };
const dark = { colorScheme: 'dark' } as const;

interface Picture {
  name: string;
  scene: string;
  /** The tick of the picture. */
  ticks: number;
  /** Settings of the view, in the form of links. */
  view?: string;
  look?: Look;
  /** Called before the picture is taken. */
  act?(viewer: Viewer, observer: Observer): Promise<void>;
}

/** Opens a section of the panel, and scrolls to it. */
async function unfold(viewer: Viewer, id: string): Promise<void> {
  const { page } = viewer;
  await page.locator('#sections > details').evaluateAll((all, open) => {
    for (const section of all as HTMLDetailsElement[]) section.open = section.id === open;
  }, id);
  await page.locator(`#${id}`).evaluate((section) => section.scrollIntoView());
}

async function watchReplay(viewer: Viewer): Promise<void> {
  await unfold(viewer, 'kept-details');
  await viewer.page.click('#recording-watch');
  await viewer.page.waitForSelector('#replay:not([hidden])');
  await viewer.page.locator('#replay-position').evaluate((slider: HTMLInputElement) => {
    slider.valueAsNumber = Number(slider.max) - 40;
    slider.dispatchEvent(new Event('input', { bubbles: true }));
    slider.dispatchEvent(new Event('change', { bubbles: true }));
  });
  await viewer.page.waitForTimeout(2000);
}

async function drawCurves(viewer: Viewer, observer: Observer): Promise<void> {
  await unfold(viewer, 'curves-details');
  await observer.request('control.play', {});
  await viewer.page.waitForTimeout(8000);
}

async function place(viewer: Viewer): Promise<void> {
  await unfold(viewer, 'build-details');
  await viewer.page.click('#add-place');
  for (let n = 0; n < 8; ++n) await viewer.page.keyboard.press('ArrowLeft');
}

const kBath = { scene: 'sliding-vat-liquid', ticks: 150, view: 'liquid:fluid' };
const kPictures: readonly Picture[] = [
  { name: 'clear-liquid', ...kBath, look: { ...kDesktop, hasBar: true } },
  {
    name: 'bodies',
    scene: 'sliding-vat-solids',
    ticks: 60,
    look: { ...kDesktop, ...dark, hasBar: true },
  },
  { name: 'surface', ...kBath, view: 'liquid:surface,solids:both', look: { ...kDesktop, ...dark } },
  { name: 'splats', ...kBath, view: 'liquid:splats' },
  {
    name: 'particles',
    ...kBath,
    view: 'liquid:particles,solids:particles',
    look: { ...kDesktop, ...dark },
  },
  {
    name: 'speed',
    scene: 'dam-break',
    ticks: 30,
    view: 'liquid:particles,colour:speed,arrows:true',
  },
  {
    name: 'cut',
    scene: 'buoyancy',
    ticks: 60,
    view: 'liquid:particles,colour:pressure,clip:y,clipAt:0.5,axes:true',
    look: { ...kDesktop, ...dark },
  },
  { name: 'build', ...kBath, act: place },
  { name: 'curves', ...kBath, look: { ...kDesktop, ...dark }, act: drawCurves },
  { name: 'replay', ...kBath, act: watchReplay },
  { name: 'phone', ...kBath, look: kPhone },
  {
    name: 'phone-dark',
    ...kBath,
    look: { ...kPhone, ...dark },
    act: async (viewer) => {
      await viewer.page.tap('#sheet');
      await unfold(viewer, 'parameters-details');
    },
  },
];

async function take(picture: Picture, server: Server, observer: Observer): Promise<void> {
  const { name, scene, ticks, view, look = kDesktop, act } = picture;
  await observer.request('scene.load', { scene });
  await observer.request('control.pause', {});
  await observer.request('control.reset', {});
  for (let done = 0; done < ticks; done += kStep) {
    await observer.request('control.step', { ticks: Math.min(kStep, ticks - done) });
  }
  const viewer = await Viewer.open(`${server.url}#view=${view ?? ''}`, {
    colorScheme: 'light',
    ...look,
  });
  try {
    await viewer.untilTick(ticks, ticks);
    await act?.(viewer, observer);
    await addStyle(viewer.page, '#hint { display: none; }');
    await viewer.page.waitForTimeout(1500); // a worker computes surfaces
    const png = await viewer.page.screenshot();
    const page = await viewer.blankPage();
    const address = `data:image/png;base64,${png.toString('base64')}`;
    const base64 = await page.evaluate(compress, [address, kMostBytes] as const);
    writeFileSync(`${kFolder}${name}.webp`, Buffer.from(base64, 'base64'));
  } finally {
    await viewer.close();
  }
}

mkdirSync(kFolder, { recursive: true });
const data = mkdtempSync(join(tmpdir(), 'vat-pictures-')); // for a recording
const server = new Server(['--data', data]);
await server.start();
const observer = await Observer.join(server.url);
try {
  const chosen = process.argv.slice(2).filter((word) => !word.includes('/') && word !== '--');
  for (const picture of kPictures) {
    if (chosen.length === 0 || chosen.includes(picture.name)) await take(picture, server, observer);
  }
} finally {
  observer.leave();
  await server.kill();
  rmSync(data, { recursive: true });
}
