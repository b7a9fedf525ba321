import { afterAll, afterEach, beforeAll, expect, it } from 'vitest';
import { startFront } from './front';
import { Observer } from './observer';
import { kAdminToken, Server } from './server';
import { Viewer } from './viewer';

/** What a user sees when things do not go as planned. */
const server = new Server();
let viewer: Viewer | undefined;
let observer: Observer | undefined;

beforeAll(() => server.start());
afterAll(() => server.kill());
afterEach(async () => {
  observer?.leave();
  await viewer?.close();
  [viewer, observer] = [undefined, undefined];
});

async function open(url = server.url): Promise<Viewer> {
  viewer = await Viewer.open(url);
  return viewer;
}

async function dropped(page: Viewer): Promise<number> {
  return Number(await page.page.getAttribute('#dropped', 'data-value'));
}

it('gets a few frames at most while it does not draw, and the newest after that', async () => {
  const page = await open();
  observer = await Observer.join(server.url);
  await page.untilTick(1);
  await page.brake(true);
  const [tick, droppedBefore] = [await page.tick(), await dropped(page)];
  // At most three of every fourth frame come before the server waits: the gap is 48 ticks or more.
  const present = () => observer!.tick();
  await expect.poll(present, { timeout: 120_000, interval: 200 }).toBeGreaterThan(tick + 60);
  await page.until('#byte-rate[data-value="0"]');
  await page.brake(false);
  await page.untilTick(tick + 60);
  expect(await dropped(page)).toBeGreaterThan(droppedBefore + 10);
  expect(page.problems).toEqual([]);
});

it('follows a scene that another client loads, also while it does not draw', async () => {
  const page = await open();
  observer = await Observer.join(server.url);
  await page.untilTick(1);
  await page.brake(true);
  await page.until('#byte-rate[data-value="0"]'); // the server waits for acknowledgements
  await observer.request('scene.load', { scene: 'rigid-stack' });
  await page.untilScene('rigid-stack');
  await page.brake(false);
  await page.untilTick(5);
  expect(await page.page.inputValue('#scene')).toBe('rigid-stack');
  expect(await page.page.title()).toContain('stack');
});

it('names a scene from outside of the catalogue', async () => {
  const page = await open();
  observer = await Observer.join(server.url);
  await page.untilTick(1);
  const scene = {
    format: 'vat.scene/1' as const,
    name: 'mine',
    title: 'My scene',
    materials: [],
    bodies: [],
  };
  await observer.request('scene.load', { scene });
  await page.untilScene('mine');
  expect(await page.page.locator('#scene option:checked').textContent()).toBe('My scene');
  await observer.request('scene.load', { scene: 'rigid-stack' });
  await page.untilScene('rigid-stack');
  expect(await page.page.locator('#scene').textContent()).not.toContain('My scene');
});

it('shows what the server refuses', async () => {
  const page = await open();
  await page.untilTick(1);
  await page.page.evaluate(() => {
    const picker = document.getElementById('scene') as HTMLSelectElement;
    picker.append(new Option('Gone', 'gone'));
  });
  await page.page.selectOption('#scene', 'gone');
  await page.until('#notices li[data-level="error"]');
  expect(await page.page.textContent('#notices')).toContain('gone');
  expect(await page.page.inputValue('#scene')).not.toBe('gone');
});

it('leaves keys to the picker while a scene is picked, and takes them elsewhere', async () => {
  const page = await open();
  observer = await Observer.join(server.url);
  await observer.request('scene.load', { scene: 'dam-break' }); // one that does not come to rest
  await page.untilScene('dam-break');
  await page.untilTick(1);
  await observer.request('control.pause', {});
  const tick = await observer.tick();
  await page.page.focus('#scene');
  await page.page.keyboard.press('s');
  await page.page.keyboard.press('r');
  await page.page.focus('#speed');
  await page.page.keyboard.press('ArrowRight');
  await expect.poll(async () => (await observer!.nextStatus()).speed).toBeGreaterThan(1);
  expect(await observer.tick()).toBe(tick); // the keys before would have come first
  await page.page.keyboard.press('S');
  await page.untilTick(tick + 1);
});

it('says that its session was closed, and goes to the one that is left', async () => {
  const page = await open();
  observer = await Observer.join(server.url);
  await page.untilTick(1);
  const [first] = (await observer.request('session.list', {})).sessions;
  await observer.request('session.create', { name: 'other', scene: 'dam-break' });
  await observer.request('access.enter', { token: kAdminToken });
  await observer.request('session.close', { session: first!.session });
  await page.untilScene('dam-break');
  await page.untilTick(1);
  expect(await page.page.textContent('#notices')).toContain('The session was closed');
  expect(page.problems).toEqual([]);
});

it('joins the session of its address, and says so where there is none', async () => {
  observer = await Observer.join(server.url);
  const scene = 'buoyancy';
  const { session } = await observer.request('session.create', { name: 'mine', scene });
  const page = await open(`${server.url}?session=${session}`);
  await page.untilScene(scene);
  await observer.request('session.close', { session });
  await page.until('#connection[data-state="waiting"]');
  expect(await page.page.textContent('#connection-text')).toContain(session);
});

it('draws again once the browser gives the graphics back', async () => {
  const page = await open();
  await page.untilTick(1);
  await page.page.evaluate(() => {
    const view = document.getElementById('view') as HTMLCanvasElement;
    const loss = view.getContext('webgl2')?.getExtension('WEBGL_lose_context');
    if (!loss) throw new Error('the browser cannot lose a context');
    loss.loseContext();
    document.addEventListener('restore', () => loss.restoreContext());
  });
  await page.until('#obstacle:not([hidden])');
  const blank = await page.picture();
  await page.page.evaluate(() => document.dispatchEvent(new Event('restore')));
  await page.until('#obstacle[hidden]');
  await page.untilTick((await page.tick()) + 5);
  expect(await page.difference(blank, await page.picture())).toBeGreaterThan(10_000);
});

it('says that it needs WebGL 2 where there is none', async () => {
  const page = await open();
  await page.page.addInitScript(() => {
    HTMLCanvasElement.prototype.getContext = () => null;
  });
  await page.page.reload();
  await page.until('#obstacle:not([hidden])');
  expect(await page.page.textContent('#obstacle')).toContain('WebGL 2');
});

it('tells a server that refuses it from one that is away', async () => {
  const front = await startFront(server.url);
  try {
    const page = await open(front.url);
    await page.page.waitForFunction(() =>
      document.getElementById('connection-text')?.textContent?.includes('refuses vat.v1'),
    );
    expect(await page.page.isDisabled('#play')).toBe(true);
  } finally {
    front.stop();
  }
});
