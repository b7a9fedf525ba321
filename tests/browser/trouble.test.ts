import { expect, it } from 'vitest';
import { controlClock } from './support/clock';
import { kAdminToken, Server } from './support/server';
import { kInTime, Visits } from './support/visits';

/** Sessions that change or close, refusals, and pages that do not draw. */
const visits = new Visits(new Server());

/** The page's clock advances by `skip`. */
const kLook = { before: controlClock };
const visit = (scene: string): Promise<void> => visits.visit(scene, kLook);

/** Waits for this number of ticks. */
async function pass(ticks: number): Promise<void> {
  const tick = await visits.observer.tick();
  await expect.poll(() => visits.observer.tick(), kInTime).toBeGreaterThan(tick + ticks);
}

/** Waits until no frames arrive. The rate is that of two seconds, which the page's clock skips. */
async function untilNoFrames(): Promise<void> {
  await visits.viewer.page.evaluate(() => window.skip(2000));
  await pass(20);
  await visits.viewer.until('#byte-rate[data-value="0"]');
}

const dropped = async (): Promise<number> =>
  Number(await visits.viewer.page.getAttribute('#dropped', 'data-value'));

it('gets few frames while it does not draw, also of a new scene, and the newest after that', async () => {
  await visit('dam-break');
  const { observer, viewer } = visits;
  await observer.request('control.play', {});
  await viewer.untilTick(1);
  await viewer.brake(true);
  const [tick, droppedBefore] = [await viewer.tick(), await dropped()];
  // At most three of every fourth frame arrive before the server waits, so the gap is at least 48
  // ticks.
  await expect.poll(() => observer.tick(), kInTime).toBeGreaterThan(tick + 60);
  await untilNoFrames(); // the server waits for acknowledgements
  await viewer.brake(false);
  await viewer.untilTick(tick + 60);
  expect(await dropped()).toBeGreaterThan(droppedBefore + 10);
  await viewer.brake(true);
  await pass(20); // the last frames arrive
  await untilNoFrames();
  await observer.request('scene.load', { scene: 'rigid-stack' });
  await viewer.untilScene('rigid-stack');
  await viewer.brake(false);
  await observer.request('control.play', {});
  await viewer.untilTick(5);
  expect(await viewer.page.inputValue('#scene')).toBe('rigid-stack');
  expect(await viewer.page.title()).toContain('stack');
});

it('names a scene from outside of the catalogue', async () => {
  await visit('rigid-stack');
  const { observer, viewer } = visits;
  const scene = {
    format: 'vat.scene/1' as const,
    name: 'mine',
    title: 'My scene',
    materials: [],
    bodies: [],
  };
  await observer.request('scene.load', { scene });
  await viewer.untilScene('mine');
  expect(await viewer.page.locator('#scene option:checked').textContent()).toBe('My scene');
  await observer.request('scene.load', { scene: 'rigid-stack' });
  await viewer.untilScene('rigid-stack');
  expect(await viewer.page.locator('#scene').textContent()).not.toContain('My scene');
});

it('shows the rejections of the server', async () => {
  await visit('rigid-stack');
  const { page } = visits.viewer;
  await page.evaluate(() => {
    document.getElementById('scene')!.append(new Option('Gone', 'gone'));
  });
  await page.selectOption('#scene', 'gone');
  await page.waitForSelector('#notices li[data-level="error"]:has-text("gone")');
  await expect.poll(() => page.inputValue('#scene'), kInTime).toBe('rigid-stack');
});

it('passes keys to the open list of scenes, and handles them elsewhere', async () => {
  await visit('dam-break');
  const { observer, viewer } = visits;
  const tick = await observer.tick();
  await viewer.page.focus('#scene');
  await viewer.page.keyboard.press('s');
  await viewer.page.keyboard.press('r');
  await viewer.page.focus('#speed');
  await viewer.page.keyboard.press('ArrowRight');
  await expect.poll(async () => (await observer.nextStatus()).speed, kInTime).toBeGreaterThan(1);
  expect(await observer.tick()).toBe(tick); // earlier keys would have arrived first
  await viewer.page.keyboard.press('S');
  await viewer.untilTick(tick + 1);
});

it('plays and pauses with the space bar, and steps and resets by buttons', async () => {
  await visit('dam-break');
  const { observer, viewer } = visits;
  const { page } = viewer;
  const before = await viewer.stillPicture();
  await page.keyboard.press('Space');
  await viewer.untilTick(10);
  await page.keyboard.press('Space');
  await viewer.until('#play[data-playing="false"]');
  const tick = await observer.tick();
  await viewer.untilTick(tick, tick);
  await visits.untilWhole();
  // A change of fewer pixels could be a single particle.
  expect(await viewer.difference(before, await viewer.stillPicture())).toBeGreaterThan(250);
  expect((await observer.nextStatus()).playing).toBe(false);
  await page.click('#step');
  await viewer.untilTick(tick + 1);
  expect(await observer.tick()).toBe(tick + 1);
  await page.click('#reset');
  await viewer.untilTick(0, 0);
});

it('draws again once the browser gives the graphics back', async () => {
  await visit('dam-break');
  const { viewer } = visits;
  const before = await viewer.stillPicture();
  await viewer.page.evaluate(() => {
    const view = document.getElementById('view') as HTMLCanvasElement;
    const loss = view.getContext('webgl2')?.getExtension('WEBGL_lose_context');
    if (!loss) throw new Error('the browser cannot lose a context');
    loss.loseContext();
    document.addEventListener('restore', () => loss.restoreContext(), { once: true });
  });
  await viewer.until('#obstacle:not([hidden])');
  const changed = async (): Promise<number> => viewer.difference(before, await viewer.picture());
  await expect.poll(changed, kInTime).toBeGreaterThan(2500);
  await viewer.page.evaluate(() => document.dispatchEvent(new Event('restore')));
  await viewer.until('#obstacle[hidden]');
  await expect.poll(changed, kInTime).toBeLessThan(20);
});

it('shows that its session was closed, and joins the remaining session', async () => {
  await visit('rigid-stack');
  const { observer, viewer } = visits;
  const [first] = (await observer.request('session.list', {})).sessions;
  await observer.request('session.create', { name: 'other', scene: 'dam-break' });
  await observer.request('access.enter', { token: kAdminToken });
  await observer.request('session.close', { session: first!.session });
  await viewer.untilScene('dam-break');
  await viewer.untilTick(1);
  expect(await viewer.page.textContent('#notices')).toContain('The session was closed');
});
