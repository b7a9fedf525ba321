import { spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { afterEach, expect, it } from 'vitest';
import { Observer } from './observer';
import { kAdminToken, Server } from './server';
import { Viewer } from './viewer';
import type { Look } from './viewer';

/** Whatever keeps a page from showing its session, or from doing what is asked of it, is said. */
let server: Server;
const pages: Viewer[] = [];
const folders: string[] = [];

afterEach(async () => {
  for (const page of pages.splice(0)) await page.close();
  await server.kill();
  for (const folder of folders.splice(0)) rmSync(folder, { recursive: true });
});

async function serve(...flags: string[]): Promise<void> {
  server = new Server(flags);
  await server.start();
}

async function open(url = server.url, look: Look = {}): Promise<Viewer> {
  const page = await Viewer.open(url, look);
  page.serverIsAway = true; // what is refused is on the browser's console too
  pages.push(page);
  return page;
}

/** The page of who runs the server. */
async function openAsAdmin(): Promise<Viewer> {
  const page = await open(`${server.url}#ticket=${encodeURIComponent(kAdminToken)}`);
  await page.untilTick(1);
  return page;
}

const says = (page: Viewer, id: string, words: string): Promise<unknown> =>
  page.page.waitForFunction(
    ([where, what]) => {
      const element = document.getElementById(where);
      return element?.checkVisibility() && element.textContent?.includes(what);
    },
    [id, words] as const,
  );

const press = (page: Viewer, words: string): Promise<void> =>
  page.page.click(`#notices button:has-text("${words}")`);

it('says in the middle that an invitation is needed, and tells of no picture', async () => {
  await serve('--access', 'token');
  const page = await open();
  await says(page, 'obstacle', 'this server lets in who has an invitation');
  await says(page, 'summary', 'There is no picture yet');
  expect(await page.page.isVisible('#hint')).toBe(false);
});

it('says in the middle that the server is full, and comes in once it is not', async () => {
  await serve('--max-connections', '1');
  const first = await open();
  await first.untilTick(1);
  const second = await open();
  await says(second, 'obstacle', 'too many connections');
  await first.close();
  await second.untilTick(1);
  expect(await second.page.isVisible('#obstacle')).toBe(false);
  expect(await second.page.isVisible('#hint')).toBe(true);
});

it('lets who watches ask for control, and others give it, by what the messages offer', async () => {
  await serve('--access', 'token');
  const owner = await openAsAdmin();
  await owner.page.keyboard.press('l');
  await owner.page.waitForFunction(() =>
    (document.getElementById('share-link') as HTMLInputElement).value.includes('invite='),
  );
  await says(owner, 'share-local', 'on this computer alone');
  const guest = await open(await owner.page.inputValue('#share-link'));
  await owner.page.keyboard.press('Escape');
  await guest.untilTick(1);
  await guest.page.click('#play');
  await says(guest, 'notices', 'only who controls may do that');
  await press(guest, 'Ask for control');
  await says(owner, 'notices', 'asks for control');
  await press(owner, 'Give control');
  await says(guest, 'notices', 'You control this session now');
  await guest.page.click('#play');
  await guest.until('#play[data-playing="false"]');
});

it('says that it was removed, and may ask to be let in again', async () => {
  await serve();
  const page = await open();
  await page.untilTick(1);
  const observer = await Observer.join(server.url);
  await observer.request('access.enter', { token: kAdminToken });
  const { session } = (await observer.request('session.list', {})).sessions[0]!;
  await observer.request('session.join', { session }); // with the role of an admin
  const others = (await observer.request('presence.list', {})).participants;
  const guest = others.find(({ role, away }) => role !== 'admin' && !away);
  await observer.request('participant.kick', { participant: guest!.participant });
  await says(page, 'connection-text', 'removed from the session');
  await says(page, 'summary', 'You are not in this session any more');
  await page.page.click('#connection-retry:has-text("Come back")');
  await page.until('#connection[data-state="open"]');
  await says(page, 'summary', 'Plays');
  observer.leave();
});

it('says that it goes on in another window, and comes back from there', async () => {
  await serve();
  const first = await open();
  await first.untilTick(1);
  const token = await first.page.evaluate(() => sessionStorage.getItem('vat.resume'));
  const second = await open();
  await second.untilTick(1); // it has a token of its own, which no longer comes
  await second.page.evaluate((value) => sessionStorage.setItem('vat.resume', value ?? ''), token);
  await second.page.reload();
  await says(first, 'connection-text', 'goes on in another window');
  await first.page.click('#connection-retry:has-text("Come back")');
  await first.until('#connection[data-state="open"]');
  await says(second, 'connection-text', 'goes on in another window');
});

it('says what is missing where the browser has no WebGL', async () => {
  await serve();
  const page = await open(server.url, {
    prepare: () => {
      HTMLCanvasElement.prototype.getContext = () => null;
    },
  });
  await says(page, 'obstacle', 'WebGL 2');
});

it('says that a part of the page was not loaded', async () => {
  await serve();
  const page = await open(server.url, {
    prepare: () => {
      const Whole = window.Worker;
      window.Worker = class extends Whole {
        constructor() {
          super('/assets/none.js');
        }
      };
    },
  });
  await says(page, 'obstacle', 'Reload the page');
});

/** A recording whose hash at position 12 is not what the simulation gives. */
function differingRecording(): Buffer {
  const script = new URL('../protocol/scripts/replays.jsonl', import.meta.url);
  const calls = readFileSync(script, 'utf8')
    .split('\n')
    .filter((line) => line.includes('"recording.import"') && !line.includes('"error"'))
    .map((line) => JSON.parse(line) as { params: { size: number; data: string } });
  const whole = calls.map(({ params }) => Buffer.from(params.data, 'base64'));
  const found = whole.filter((bytes, n) => bytes.length === calls[n]!.params.size).pop();
  if (!found) throw new Error('the script has no whole recording');
  return found;
}

it('says where a replay differs from what was recorded, and how to go on', async () => {
  await serve();
  const page = await open();
  await page.untilTick(1);
  await page.page.setInputFiles('#recording-input', {
    name: 'differs.vatrec',
    mimeType: 'application/octet-stream',
    buffer: differingRecording(),
  });
  await page.page.waitForSelector('#replay:not([hidden])');
  await page.page.focus('#replay-position');
  await page.page.keyboard.press('End');
  await says(page, 'replay-words', 'what is computed here is not what was recorded');
  await says(page, 'replay-words', 'the time line leads to any other place');
  expect(await page.page.isVisible('#replay-mark')).toBe(true);
  await page.page.keyboard.press('Home');
  await page.until('#replay-words[data-diverged="false"]');
});

/** What the server has written, as another version of it could have. */
function alter(file: string, command: string): void {
  const program =
    'import sqlite3, sys; c = sqlite3.connect(sys.argv[1]); c.execute(sys.argv[2]); c.commit()';
  const { status, stderr } = spawnSync('python3', ['-c', program, file, command]);
  if (status !== 0) throw new Error(stderr.toString());
}

it('says that a session came back otherwise, and goes on after a reset', async () => {
  const data = mkdtempSync(join(tmpdir(), 'vat-words-'));
  folders.push(data);
  await serve('--data', data);
  const page = await open();
  await page.untilTick(5);
  const observer = await Observer.join(server.url);
  await observer.request('access.enter', { token: kAdminToken });
  await observer.request('server.drain', { seconds: 0 });
  await server.ended();
  alter(join(data, 'checkpoints.db'), 'DELETE FROM checkpoints');
  alter(join(data, 'vat.db'), 'UPDATE sessions SET hash = hash + 1');
  await server.start();
  await says(page, 'notices', 'did not come back as it was, and stands still');
  await page.page.click('#reset');
  await page.untilTick(0, 0);
  await page.page.click('#play');
  await page.untilTick(5);
  observer.leave();
});

it('says that a server without a folder records nothing, and how it would', async () => {
  await serve();
  const page = await open();
  await page.untilTick(1);
  await page.page.click('#kept-details > summary');
  await says(page, 'recording-note', 'records nothing: start it with --data');
  expect(await page.page.isDisabled('#recording-watch')).toBe(true);
});

it('says that it is slow while it plays, and shows all once it stands still', async () => {
  await serve();
  const page = await open(server.url, {
    prepare: () => {
      const next = window.requestAnimationFrame.bind(window);
      window.requestAnimationFrame = (callback) => window.setTimeout(() => next(callback), 250);
    },
  });
  await page.until('#connection[data-slow="true"]');
  await says(page, 'connection-text', 'Slow: ');
  await page.page.click('#play');
  await page.until('#play[data-playing="false"]');
  await page.until('#connection[data-slow="false"]');
  await says(page, 'quality', 'every frame');
});
