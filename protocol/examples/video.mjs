/**
 * video.mjs RECORDING.vatrec VIDEO.webm SECONDS URL: the viewer plays a recording in a browser
 * without a window, and saves it as a video. It needs `npm --prefix web ci` and the package
 * chromium-headless-shell, or the path of another Chromium in CHROMIUM.
 */
import { createRequire } from 'node:module';

const require = createRequire(new URL('../../web/package.json', import.meta.url));
const { chromium } = require('playwright-core');
const [recording, video, seconds, url] = process.argv.slice(2);

const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium-headless-shell',
  args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader'],
});
const page = await browser.newPage({ viewport: { width: 1280, height: 720 } });
await page.goto(url.replace(/^ws/, 'http').replace(/\/ws$/, '/'));
await page.waitForSelector('#view[data-joined="true"]');
await page.setInputFiles('#recording-input', recording);
await page.waitForSelector('#replay:not([hidden])');
await page.keyboard.press('c'); // the menu of the camera
await page.click('#video');
await page.waitForSelector('#video[aria-pressed="true"]');
await page.waitForTimeout(1000 * Number(seconds));
const download = page.waitForEvent('download');
await page.click('#video');
await (await download).saveAs(video);
console.log(`saved ${(await download).suggestedFilename().replace(/-[\d.]+s/, '')}`);
await browser.close();
