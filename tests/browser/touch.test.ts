import { readFileSync } from 'node:fs';
import { afterAll, afterEach, beforeAll, beforeEach, expect, it } from 'vitest';
import { Observer } from './observer';
import { Server } from './server';
import { Viewer } from './viewer';

/** What people do with the page beside playing: choose, drop, tilt, look closer, meet, share. */
const server = new Server();
const open: Viewer[] = [];
let viewer: Viewer;
let observer: Observer;

beforeAll(() => server.start());
afterAll(() => server.kill());

beforeEach(async () => {
  observer = await Observer.join(server.url);
  await observer.request('scene.load', { scene: 'rigid-stack' });
  await observer.request('control.play', {});
  viewer = await visit();
});

afterEach(async () => {
  observer.leave();
  const problems = open.flatMap((one) => one.problems);
  for (const one of open.splice(0)) await one.close();
  expect(problems).toEqual([]);
});

async function visit(...[url, look]: Partial<Parameters<typeof Viewer.open>>): Promise<Viewer> {
  const one = await Viewer.open(url ?? server.url, look);
  open.push(one);
  await one.untilTick(1);
  return one;
}

async function unfold(id: string): Promise<void> {
  await viewer.page.click(`#${id} > summary`);
}

it('loads a scene that is chosen by its picture', async () => {
  await viewer.page.keyboard.press('g');
  const card = viewer.page.locator('#gallery button[data-scene="buoyancy"]');
  const picture = card.locator('img');
  await expect
    .poll(() => picture.evaluate((image: HTMLImageElement) => image.naturalWidth), {
      timeout: 60_000,
    })
    .toBeGreaterThan(100);
  await card.click();
  await viewer.untilScene('buoyancy');
  expect(await viewer.page.locator('#gallery').evaluate((box: HTMLDialogElement) => box.open)).toBe(
    false,
  );
});

it('loads a scene file that is dropped on it, and says why another is none', async () => {
  const drop = (name: string, text: string): Promise<void> =>
    viewer.page.evaluate(
      ([file, content]) => {
        const dataTransfer = new DataTransfer();
        dataTransfer.items.add(new File([content], file));
        document.body.dispatchEvent(
          new DragEvent('drop', { dataTransfer, bubbles: true, cancelable: true }),
        );
      },
      [name, text] as const,
    );
  await drop('broken.json', '{');
  await viewer.until('#notices li[data-level="error"]');
  expect(await viewer.page.textContent('#notices')).toContain('broken.json');
  const bad = { format: 'vat.scene/1', materials: [], bodies: [{ name: 'a' }] };
  await drop('bad.json', JSON.stringify(bad));
  await viewer.page.waitForFunction(() =>
    document.getElementById('notices')?.textContent?.includes('/bodies/0'),
  );
  const pool = new URL('../protocol/scenes/pool.json', import.meta.url);
  await drop('dropped-pool.json', readFileSync(pool, 'utf8'));
  await expect
    .poll(async () => (await observer.request('session.list', {})).sessions[0]?.scene, {
      timeout: 60_000,
    })
    .not.toBe('rigid-stack');
  await viewer.page.waitForFunction(
    () => document.getElementById('view')?.dataset.scene !== 'rigid-stack',
  );
});

it('tilts gravity with the ball, and takes it back', async () => {
  await unfold('parameters-details');
  const gravity = async (): Promise<number[]> =>
    (await observer.request('session.join', {})).description.gravity;
  await viewer.page.locator('#tilt').scrollIntoViewIfNeeded();
  const pad = (await viewer.page.locator('#tilt').boundingBox())!;
  const middle = { x: pad.x + pad.width / 2, y: pad.y + pad.height / 2 };
  await viewer.page.mouse.move(middle.x, middle.y);
  await viewer.page.mouse.down();
  await viewer.page.mouse.move(middle.x + pad.width / 4, middle.y, { steps: 3 });
  await viewer.page.mouse.up();
  // Half of the way is half of 60 degrees, within the two that a pixel is.
  const inTime = { timeout: 60_000, interval: 300 };
  await expect.poll(async () => (await gravity())[0], inTime).toBeGreaterThan(4.6);
  expect((await gravity())[0]).toBeLessThan(5.2);
  await viewer.page.click('#gravity-reset');
  await expect.poll(gravity, inTime).toEqual([0, 0, -9.81]);
});

it('tells the numbers of a particle that is clicked', async () => {
  await observer.request('control.pause', {});
  await viewer.untilTick(await observer.tick());
  const { x, y } = await viewer.findParticle();
  await viewer.page.mouse.click(x, y);
  await viewer.until('#inspector:not([hidden])');
  const text = (await viewer.page.textContent('#inspector')) ?? '';
  const found = /^(.*) · particle (\d+)/.exec(text);
  const { bodies } = await observer.request('state.query', { bodies: [found?.[1] ?? ''] });
  const place = bodies[0]!.positions[Number(found?.[2])]!;
  const [px, py, pz] = /Place([-\d.]+), ([-\d.]+), ([-\d.]+) m/.exec(text)!.slice(1).map(Number);
  expect(Math.hypot(px! - place[0], py! - place[1], pz! - place[2])).toBeLessThan(0.005);
});

it('lists its keys, and turns and zooms the picture by them', async () => {
  await viewer.page.keyboard.press('?');
  await viewer.until('#keys[open]');
  const listed = (await viewer.page.textContent('#keys-list')) ?? '';
  for (const words of ['play, pause', 'one tick', 'turn the view', 'zoom']) {
    expect(listed).toContain(words);
  }
  await viewer.page.keyboard.press('Escape');
  await observer.request('control.pause', {});
  await viewer.untilTick(await observer.tick());
  const before = await viewer.picture();
  await viewer.page.focus('#view');
  for (let n = 0; n < 6; ++n) await viewer.page.keyboard.press('ArrowRight');
  await viewer.page.waitForTimeout(500);
  const after = await viewer.picture();
  expect(await viewer.difference(before, after)).toBeGreaterThan(5000);
});

it('shows who is here by name, where they point, and what they hold', async () => {
  await unfold('people-details');
  await observer.request('participant.rename', { name: 'Ann' });
  await observer.request('presence.point', { position: [0, 0, 0] });
  await viewer.page.waitForSelector('#people li:has-text("Ann")');
  await viewer.page.waitForSelector('#cursors > span:has-text("Ann")');
  const { bodies } = await observer.request('state.query', {});
  const held = bodies.find(({ kind }) => kind === 'rigid')!;
  await observer.request('grab.start', {
    body: held.body,
    particle: 0,
    target: held.positions[0]!,
  });
  await viewer.page.waitForSelector(`#people li:has-text("Ann"):has-text("holds ${held.name}")`);
  await viewer.page.fill('#rename-name', 'Bob');
  await viewer.page.keyboard.press('Enter');
  await expect
    .poll(async () => (await observer.request('presence.list', {})).participants, {
      timeout: 60_000,
    })
    .toContainEqual(expect.objectContaining({ name: 'Bob', role: 'controller' }));
});

it('gives control to who asks for it', async () => {
  // In a session of its own, whose owner says that those who come watch.
  const { session } = await observer.request('session.create', {
    name: 'ours',
    scene: 'rigid-stack',
  });
  await observer.request('session.join', { session });
  await observer.request('session.configure', { default_role: 'viewer' });
  viewer = await visit(`${server.url}?session=${session}`);
  await unfold('people-details');
  await viewer.page.click('#control-request');
  await viewer.page.waitForSelector('#notices li:has-text("Those in control are asked")');
  const ours = (await observer.request('presence.list', {})).participants.find(
    ({ role }) => role === 'viewer',
  );
  await observer.request('control.hand_over', { participant: ours!.participant });
  await viewer.page.waitForSelector('#people li:has-text("(you)"):has-text("controls")');
  expect(await viewer.page.isVisible('#control-request')).toBe(false);
  await observer.request('session.close', { session }).catch(() => undefined);
});

it('makes a link by which another sees the same from the same place', async () => {
  await observer.request('control.pause', {});
  await viewer.untilTick(await observer.tick());
  await viewer.page.focus('#view');
  for (let n = 0; n < 8; ++n) await viewer.page.keyboard.press('ArrowLeft');
  await viewer.page.waitForTimeout(500);
  await viewer.page.keyboard.press('l');
  const link = await viewer.page.inputValue('#share-link');
  await viewer.page.keyboard.press('Escape');
  const other = await Viewer.open(link);
  open.push(other);
  await other.until('#view[data-tick]');
  const plain = await visit();
  for (const one of [viewer, other, plain]) {
    await one.page.focus('#view');
    await one.page.keyboard.press('Shift'); // the hint goes once the picture is used
  }
  await viewer.page.waitForTimeout(2000);
  const still = await viewer.picture();
  const same = await viewer.difference(still, await other.picture());
  const different = await viewer.difference(still, await plain.picture());
  expect(different).toBeGreaterThan(5000);
  expect(same).toBeLessThan(different / 10);
});

it('switches between light and dark, also the picture', async () => {
  const colour = (): Promise<string> =>
    viewer.page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  await viewer.page.keyboard.press('t');
  const dark = await colour();
  await viewer.page.keyboard.press('t');
  expect(await colour()).not.toBe(dark);
});

it('is a sheet on a phone, which leaves room for the picture', async () => {
  viewer = await visit(server.url, {
    viewport: { width: 390, height: 800 },
    hasTouch: true,
    isMobile: true,
  });
  const height = async (id: string): Promise<number> =>
    (await viewer.page.locator(id).boundingBox())!.height;
  expect(await height('#view')).toBeGreaterThan(480);
  await viewer.page.tap('#sheet');
  await viewer.page.waitForSelector('#scene', { state: 'visible' });
  expect(await height('#view')).toBeGreaterThan(250);
  const wide = await viewer.page.evaluate(() => document.documentElement.scrollWidth);
  expect(wide).toBe(390);
});
