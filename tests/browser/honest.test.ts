import { afterEach, beforeEach, expect, it } from 'vitest';
import { Observer } from './observer';
import { Proxy } from './proxy';
import type { Ways } from './proxy';
import { kAdminToken, Server } from './server';
import { Viewer } from './viewer';

/** Servers that are older, stopped, stuck or not as they were: the page says so, and what to do. */
let server: Server;
let viewer: Viewer | undefined;
let proxy: Proxy | undefined;

beforeEach(async () => {
  server = new Server();
  await server.start();
});
afterEach(async () => {
  await viewer?.close();
  proxy?.stop();
  await server.kill();
  [viewer, proxy] = [undefined, undefined];
});

async function through(ways: Ways = {}): Promise<{ page: Viewer; between: Proxy }> {
  const between = (proxy = new Proxy(server.url, ways));
  const page = (viewer = await Viewer.open(await between.start(), { isUnrecorded: true }));
  await page.untilTick(1);
  return { page, between };
}

const says = (page: Viewer, id: string, words: string): Promise<unknown> =>
  page.page.waitForFunction(
    ([where, what]) => document.getElementById(where)?.textContent?.includes(what),
    [id, words] as const,
  );

it('works with a server that knows less, and says what it cannot do', async () => {
  const { page } = await through({
    unknown: ['scene.get', 'session.saves', 'session.stats', 'replay.open', 'scene.save'],
  });
  await page.page.click('#play');
  await page.until('#play[data-playing="false"]');
  expect(await page.page.isVisible('#pour-row')).toBe(false); // only the scene tells of liquids
  await page.page.click('#kept-details > summary');
  await says(page, 'notices', 'This server is older than this page');
  await says(page, 'notices', 'session.saves');
  await page.page.click('#curves-details > summary');
  await page.page.waitForSelector('.chart canvas');
  await page.page.click('#play');
  await page.until('#play[data-playing="true"]');
  expect(page.problems).toEqual([]);
});

it('says that no picture comes where the line is stuck, and comes back with it', async () => {
  const { page, between } = await through();
  between.freeze(true);
  await says(page, 'summary', 'No new picture');
  await page.until('#connection[data-state="waiting"]');
  await says(page, 'connection-text', 'gives no answer');
  await says(page, 'summary', 'the last picture');
  between.freeze(false);
  await page.until('#connection[data-state="open"]');
  await page.until('#view[data-tick]');
});

it('says that the server stops, that it is away, and goes on once it is back', async () => {
  const page = (viewer = await Viewer.open(server.url));
  await page.untilTick(1);
  page.serverIsAway = true;
  const observer = await Observer.join(server.url);
  await observer.request('access.enter', { token: kAdminToken });
  await observer.request('server.drain', { seconds: 3 });
  await says(page, 'notices', 'The server stops in 3 s');
  await page.until('#connection[data-state="waiting"]');
  observer.leave();
  await says(page, 'summary', 'the last picture');
  await server.ended();
  await server.start();
  await page.until('#connection[data-state="open"]');
  await page.untilTick(1);
});

it('says that the session of its address is gone, and leads to the one that is there', async () => {
  const page = (viewer = await Viewer.open(`${server.url}?session=s99`));
  await page.until('#connection[data-state="waiting"]');
  await says(page, 'connection-text', 's99');
  await page.page.click('#connection-first');
  await page.until('#connection[data-state="open"]');
  await page.untilTick(1);
  expect(new URL(page.page.url()).search).toBe('');
  expect(await page.page.isVisible('#connection-first')).toBe(false);
});
