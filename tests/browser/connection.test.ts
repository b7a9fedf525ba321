import { afterEach, expect, it } from 'vitest';
import { controlClock } from './support/clock';
import { Observer } from './support/observer';
import { Proxy } from './support/proxy';
import type { Ways } from './support/proxy';
import { kAdminToken, Server } from './support/server';
import { openPage } from './support/shared';
import type { Look, Viewer } from './support/viewer';
import { says } from './support/visits';

/**
 * Messages of the page about servers that are full, older, stuck, stopped or closed to strangers.
 */
let server: Server;
let proxy: Proxy | undefined;
const pages: Viewer[] = [];

afterEach(async () => {
  for (const page of pages.splice(0)) await page.close();
  proxy?.stop();
  proxy = undefined;
  await server.kill();
});

async function serve(...flags: string[]): Promise<void> {
  server = new Server(['--scene', 'rigid-stack', ...flags]);
  await server.start();
}

async function open(url = server.url, look: Look = {}): Promise<Viewer> {
  // A small picture, because drawing is not the subject.
  const page = await openPage(url, { deviceScaleFactor: 0.1, ...look });
  page.serverIsAway = true; // refusals appear on the browser's console
  pages.push(page);
  return page;
}

async function through(ways: Ways, look: Look = {}): Promise<{ page: Viewer; between: Proxy }> {
  await serve();
  const between = (proxy = new Proxy(server.url, ways));
  const page = await open(await between.start(), { isUnrecorded: true, ...look });
  return { page, between };
}

const isOpen = (page: Viewer): Promise<void> => page.until('#connection[data-state="open"]');
const isWaiting = (page: Viewer): Promise<void> => page.until('#connection[data-state="waiting"]');

it('shows that an invitation is needed; viewers request control with the button of the message', async () => {
  await serve('--access', 'token');
  const stranger = await open();
  await says(stranger, 'obstacle', 'this server needs an invitation');
  await says(stranger, 'summary', 'No frame has arrived');
  expect(await stranger.page.isVisible('#hint')).toBe(false);
  await stranger.close();
  const owner = await open(`${server.url}#ticket=${encodeURIComponent(kAdminToken)}`);
  await owner.untilTick(0);
  await owner.page.keyboard.press('l');
  await owner.page.waitForFunction(() =>
    (document.getElementById('share-link') as HTMLInputElement).value.includes('invite='),
  );
  await says(owner, 'share-local', 'on this computer only');
  const guest = await open(await owner.page.inputValue('#share-link'));
  await owner.page.keyboard.press('Escape');
  await guest.untilTick(0);
  await guest.page.click('#play');
  await says(guest, 'notices', 'Viewers cannot do this');
  await guest.page.click('#notices button:has-text("Ask for control")');
  await says(owner, 'notices', 'asks for control');
  await owner.page.click('#notices button:has-text("Give control")');
  await says(guest, 'notices', 'You are a controller now');
  await guest.page.click('#play');
  await guest.until('#play[data-playing="false"]');
});

it('shows that the server is full, and joins when a place is free', async () => {
  await serve('--max-connections', '1');
  const first = await open();
  await first.untilTick(0);
  const second = await open();
  await says(second, 'obstacle', 'too many connections');
  await first.close();
  await second.untilTick(0);
  expect(await second.page.isVisible('#obstacle')).toBe(false);
  expect(await second.page.isVisible('#hint')).toBe(true);
});

it('shows that the participant was removed or continues in another window, and joins again', async () => {
  await serve();
  const first = await open();
  await first.untilTick(0);
  const observer = await Observer.join(server.url);
  await observer.request('access.enter', { token: kAdminToken });
  const { session } = (await observer.request('session.list', {})).sessions[0]!;
  await observer.request('session.join', { session }); // with the role of an admin
  const others = (await observer.request('presence.list', {})).participants;
  const guest = others.find(({ role, away }) => role !== 'admin' && !away);
  await observer.request('participant.kick', { participant: guest!.participant });
  observer.leave();
  await says(first, 'connection-text', 'removed from the session');
  await says(first, 'summary', 'You have left this session');
  await first.page.click('#connection-retry:has-text("Come back")');
  await isOpen(first);
  await says(first, 'summary', 'Plays');

  const token = await first.page.evaluate(() => sessionStorage.getItem('vat.resume'));
  const second = await open();
  await second.untilTick(0); // its separate token no longer arrives
  await second.page.evaluate((value) => sessionStorage.setItem('vat.resume', value ?? ''), token);
  await second.page.reload();
  await says(first, 'connection-text', 'continues in another window');
  await first.page.click('#connection-retry:has-text("Come back")');
  await isOpen(first);
  await says(second, 'connection-text', 'continues in another window');
});

it('shows the node of a cluster, and that the session moves to another one', async () => {
  const { page, between } = await through({ node: 'a' });
  await says(page, 'connection-node', 'on a');
  const next = new Proxy(server.url, { node: 'b' });
  try {
    const texts = await page.page.evaluateHandle(collectTexts);
    between.moveTo(await next.start());
    await says(page, 'connection-node', 'on b');
    expect(await texts.jsonValue()).toContain('The session moves …');
  } finally {
    next.stop();
  }
});

it('works with an older server, and names the functions that it lacks', async () => {
  const { page } = await through({
    unknown: ['scene.get', 'session.saves', 'session.stats', 'replay.open', 'scene.save'],
  });
  page.serverIsAway = false;
  await page.untilTick(0);
  await page.page.click('#play');
  await page.until('#play[data-playing="false"]');
  expect(await page.page.isVisible('#pour-row')).toBe(false); // only the scene contains the liquids
  await page.page.click('#kept-details > summary');
  await says(page, 'notices', 'This server is older than the page');
  await says(page, 'notices', 'session.saves');
  await page.page.click('#curves-details > summary');
  await page.page.waitForSelector('.chart canvas');
  await page.page.click('#play');
  await page.until('#play[data-playing="true"]');
  expect(page.problems).toEqual([]);
});

it('distinguishes a server that rejects it from a stopped server', async () => {
  const { page } = await through({ refuses: true });
  await says(page, 'connection-text', 'does not support vat.v1');
  expect(await page.page.isDisabled('#play')).toBe(true);
});

/**
 * Runs in the page's worker: its timers fire immediately if another page of the server requests it.
 */
const kTimers = `{
  const begin = self.setTimeout, waiting = new Map();
  self.setTimeout = (act, ms) => {
    const id = begin(() => waiting.delete(id) && act(), ms);
    waiting.set(id, act);
    return id;
  };
  self.clearTimeout = (id) => waiting.delete(id);
  new BroadcastChannel('timers').onmessage = () => {
    const all = [...waiting];
    waiting.clear();
    for (const [, act] of all) act();
  };
}`;

const fireTimers = ({ page }: Viewer): Promise<void> =>
  page.evaluate(() => {
    const channel = new BroadcastChannel('timers');
    channel.postMessage('');
    channel.close();
  });

it('shows that the connection is stuck, and continues afterwards', async () => {
  const { page, between } = await through({ worker: kTimers }, { before: controlClock });
  await page.untilTick(0);
  between.freeze(true);
  await page.page.evaluate(() => window.skip(4000));
  await says(page, 'summary', 'No new frame');
  // The page measures the clock, and the reply is late.
  const reason = async (): Promise<string> => {
    await fireTimers(page);
    return (await page.page.textContent('#connection-text')) ?? '';
  };
  await expect.poll(reason, { timeout: 120_000, interval: 50 }).toContain('does not answer');
  await says(page, 'summary', 'the last frame');
  between.freeze(false);
  await fireTimers(page);
  await isOpen(page);
  await page.until('#view[data-tick]');
});

it('shows that the server stops, that it has stopped, and continues with the next server', async () => {
  await serve();
  const page = await open();
  await page.untilTick(0);
  const observer = await Observer.join(server.url);
  await observer.request('access.enter', { token: kAdminToken });
  await observer.request('server.drain', { seconds: 1 });
  await says(page, 'notices', 'The server stops within 1 s');
  await isWaiting(page);
  expect(await page.page.textContent('#connection')).toContain('Not connected');
  observer.leave();
  await says(page, 'summary', 'the last frame');
  await server.ended();
  await server.start();
  await isOpen(page);
  await page.untilTick(0);
});

it('joins the session of its address, shows that it was closed, and offers another session', async () => {
  await serve();
  const observer = await Observer.join(server.url);
  const scene = 'buoyancy';
  const { session } = await observer.request('session.create', { name: 'mine', scene });
  const page = await open(`${server.url}?session=${session}`);
  await page.untilScene(scene);
  await observer.request('session.close', { session });
  observer.leave();
  await isWaiting(page);
  await says(page, 'connection-text', session);
  await page.page.click('#connection-first');
  await isOpen(page);
  await page.untilScene('rigid-stack');
  await page.untilTick(0);
  expect(new URL(page.page.url()).search).toBe('');
  expect(await page.page.isVisible('#connection-first')).toBe(false);
});

/** Runs in the browser. Returns a list to which later texts of the connection are added. */
function collectTexts(): string[] {
  const line = document.getElementById('connection-text')!;
  const texts: string[] = [];
  new MutationObserver(() => texts.push(line.textContent ?? '')).observe(line, { childList: true });
  return texts;
}
