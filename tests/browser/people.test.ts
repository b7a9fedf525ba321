import { expect, it } from 'vitest';
import { Observer } from './support/observer';
import { Server } from './support/server';
import { openPage } from './support/shared';
import { kInTime, unfold, Visits } from './support/visits';

/** Other participants of the session, their choice of scenes, and links. */
const visits = new Visits(new Server(['--scene', 'rigid-stack']));

it('loads a scene that is chosen by its picture', async () => {
  await visits.visit('rigid-stack');
  const { page } = visits.viewer;
  await page.keyboard.press('g');
  const card = page.locator('#gallery button[data-scene="buoyancy"]');
  await expect
    .poll(
      () => card.locator('img').evaluate((image: HTMLImageElement) => image.naturalWidth),
      kInTime,
    )
    .toBeGreaterThan(100);
  await card.click();
  await visits.viewer.untilScene('buoyancy');
  expect(await page.isVisible('#gallery')).toBe(false);
});

it('loads a dropped scene file, and shows the fault of an invalid file', async () => {
  await visits.visit('rigid-stack');
  const { page } = visits.viewer;
  const drop = (name: string, text: string): Promise<void> =>
    page.evaluate(
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
  await page.waitForSelector('#notices li[data-level="error"]:has-text("broken.json")');
  const bad = { format: 'vat.scene/1', materials: [], bodies: [{ name: 'a' }] };
  await drop('bad.json', JSON.stringify(bad));
  await page.waitForSelector('#notices li:has-text("/bodies/0")');
  await drop('dropped.json', '{"format": "vat.scene/1", "materials": [], "bodies": []}');
  await visits.viewer.untilScene('dropped');
  const [session] = (await visits.observer.request('session.list', {})).sessions;
  expect(session!.scene).toBe('dropped');
});

it('shows the participants by name, their pointers, and their grabbed bodies', async () => {
  await visits.visit('rigid-stack');
  const { observer, viewer } = visits;
  await unfold(viewer, 'people-details');
  await observer.request('participant.rename', { name: 'Ann' });
  await observer.request('presence.point', { position: [0, 0, 0] });
  await viewer.page.waitForSelector('#people li:has-text("Ann")');
  await viewer.page.waitForSelector('#cursors > span:has-text("Ann")');
  const { bodies } = await observer.request('state.query', {});
  const held = bodies.find(({ kind }) => kind === 'rigid')!;
  const { grab } = await observer.request('grab.start', {
    body: held.body,
    particle: 0,
    target: held.positions[0]!,
  });
  await viewer.page.waitForSelector(`#people li:has-text("Ann"):has-text("holds ${held.name}")`);
  await observer.request('grab.end', { grab });
  // Other participants see the pointer until it leaves the picture.
  const isPointing = async (): Promise<boolean> =>
    (await observer.request('presence.list', {})).participants.some(
      ({ name, pointer }) => name !== 'Ann' && pointer,
    );
  await viewer.page.hover('#view');
  await expect.poll(isPointing, kInTime).toBe(true);
  await viewer.page.hover('#summary');
  await expect.poll(isPointing, kInTime).toBe(false);
  await viewer.page.fill('#rename-name', 'Bob');
  await viewer.page.keyboard.press('Enter');
  await expect
    .poll(async () => (await observer.request('presence.list', {})).participants, kInTime)
    .toContainEqual(expect.objectContaining({ name: 'Bob', role: 'controller' }));
});

it('gives control to a viewer that requests it', async () => {
  // A separate session: its owner admits others as viewers only.
  const owner = await Observer.join(visits.server.url);
  const { session } = await owner.request('session.create', { name: 'ours', scene: 'rigid-stack' });
  await owner.request('session.join', { session });
  await owner.request('session.configure', { default_role: 'viewer' });
  const guest = await openPage(`${visits.server.url}?session=${session}`);
  await guest.untilTick(0);
  await unfold(guest, 'people-details');
  await guest.page.click('#control-request');
  await guest.page.waitForSelector('#notices li:has-text("Your request was sent")');
  const { participants } = await owner.request('presence.list', {});
  const { participant } = participants.find(({ role }) => role === 'viewer')!;
  await owner.request('control.hand_over', { participant });
  await guest.page.waitForSelector('#people li:has-text("(you)"):has-text("controls")');
  expect(await guest.page.isVisible('#control-request')).toBe(false);
  expect(guest.problems).toEqual([]);
  await guest.close();
  owner.leave();
});

it('permits the governor by a file of vat tune, and ends the permission', async () => {
  const observer = await Observer.join(visits.server.url);
  const { session } = await observer.request('session.create', {
    name: 'tuned',
    scene: 'rigid-stack',
  });
  await observer.request('session.join', { session });
  const owner = await openPage(`${visits.server.url}?session=${session}`);
  await owner.untilTick(0);
  await unfold(owner, 'people-details');
  expect(await owner.page.isVisible('#governor-row')).toBe(false); // a controller
  const { participants } = await observer.request('presence.list', {});
  const { participant } = participants.find(({ role }) => role === 'controller')!;
  await observer.request('participant.set_role', { participant, role: 'owner' });
  await owner.page.waitForSelector('#governor-row');
  const choose = (text: string): Promise<void> =>
    owner.page.setInputFiles('#governor-file', {
      name: 'front.json',
      mimeType: 'application/json',
      buffer: Buffer.from(text),
    });
  await choose('{}');
  await owner.page.waitForSelector('#notices li:has-text("has no points of the governor")');
  const { scene } = await observer.request('scene.get', {});
  const { integrator, step } = scene.numerics as { integrator: string; step: number };
  const governor = [
    { integrator, step: step / 2, error: 1e-3, seconds: 1 },
    { integrator, step, error: 1e-2, seconds: 0.5 },
  ];
  await choose(JSON.stringify({ governor }));
  await owner.page.waitForSelector('#governor:checked');
  await owner.page.click('#governor');
  await owner.page.waitForSelector('#governor:not(:checked)');
  expect(owner.problems).toEqual([]);
  await owner.close();
  observer.leave();
});

it('switches between light and dark', async () => {
  await visits.visit('rigid-stack');
  const { page } = visits.viewer;
  const colour = (): Promise<string> =>
    page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  await page.keyboard.press('t');
  const first = await colour();
  await page.keyboard.press('t');
  expect(await colour()).not.toBe(first);
  await page.keyboard.press('t'); // the system's theme
});
