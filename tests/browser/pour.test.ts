import { expect, it } from 'vitest';
import { formatCount } from '../../web/viewer/panel/format';
import { kPhone, Visits } from './visits';

/** What hands do beside dragging: pour, tilt a device, hold by keys, and ask what a body weighs. */
const visits = new Visits();

const kInTime = { timeout: 120_000, interval: 200 };

/** The parameters on a phone. */
async function takePhone(): Promise<void> {
  await visits.visit('dam-break', kPhone);
  await visits.viewer.page.tap('#sheet');
  await visits.viewer.page.click('#parameters-details > summary');
}

it('pours drops below the top, each where there is room', async () => {
  await visits.visit('dam-break');
  const before = (await visits.observer.request('state.query', {})).bodies.length;
  const drops = async (): Promise<number> =>
    (await visits.observer.request('state.query', {})).bodies.length - before;
  await visits.viewer.page.click('#pour');
  await expect.poll(drops, kInTime).toBe(1);
  await visits.viewer.page.focus('#view');
  // As a key repeats that is held: none comes before the last one is seen.
  const poured = async (): Promise<number> => {
    await visits.viewer.page.keyboard.press('p');
    await visits.viewer.page.keyboard.press('p');
    return drops();
  };
  await expect.poll(poured, kInTime).toBeGreaterThan(1);
  const { bodies } = await visits.observer.request('state.query', {});
  const [first, second] = bodies.slice(before, before + 2).map(({ positions }) => positions);
  const { vat } = (await visits.observer.request('session.join', {})).description;
  for (const [x, y, z] of [...first!, ...second!]) {
    expect(x > vat!.min[0] && x < vat!.max[0] && y > vat!.min[1] && y < vat!.max[1]).toBe(true);
    expect(z).toBeGreaterThan(vat!.min[2] + 0.5 * (vat!.max[2] - vat!.min[2]));
  }
  const spacing = (await visits.scene()).bodies[0]!.spacing!;
  const gaps = first!.flatMap((a) =>
    second!.map((b) => Math.hypot(...a.map((value, axis) => value - b[axis]!))),
  );
  expect(Math.min(...gaps)).toBeGreaterThan(spacing);
});

it('opens and closes the taps of a scene', async () => {
  await visits.visit('pour');
  const isOpen = async (): Promise<boolean | undefined> =>
    (await visits.scene()).emitters?.[0]?.open;
  const tap = visits.viewer.page.locator('#pour-row button[data-emitter="tap"]');
  expect(await tap.textContent()).toBe('Close tap');
  await tap.click();
  await expect.poll(isOpen, kInTime).toBe(false);
  await visits.viewer.page.waitForSelector('#pour-row button:has-text("Open tap")');
  await tap.click();
  await expect.poll(async () => (await isOpen()) ?? true, kInTime).toBe(true);
});

it('has nothing to pour where there is no liquid', async () => {
  await visits.visit('rigid-stack');
  expect(await visits.viewer.page.isVisible('#pour-row')).toBe(false);
});

it('holds a body by keys, pulls it, and lets it go', async () => {
  await visits.visit('rigid-stack');
  await visits.viewer.page.focus('#view');
  await visits.viewer.page.keyboard.press('b');
  await visits.viewer.until('#view[data-held-body]');
  const held = Number(await visits.viewer.said('heldBody'));
  const target = async (): Promise<number[]> =>
    (await visits.viewer.said('heldTarget'))!.split(' ').map(Number);
  const before = await target();
  for (let n = 0; n < 8; ++n) await visits.viewer.page.keyboard.press('ArrowUp');
  const [x, y, z] = await target();
  expect([x, y]).toEqual(before.slice(0, 2));
  expect(z).toBeGreaterThan(before[2]! + 0.05);
  await expect
    .poll(() => visits.viewer.page.textContent('#summary'), kInTime)
    .toContain('you hold');
  const grabs = async (): Promise<number[]> =>
    (await visits.observer.request('presence.list', {})).participants.flatMap((one) => one.grabs);
  expect(await grabs()).toEqual([held]);
  const height = async (): Promise<number> => {
    const { positions } = await visits.observer.body(held);
    return positions.reduce((sum, place) => sum + place[2], 0) / positions.length;
  };
  const low = await height();
  const lifted = async (): Promise<number> => {
    await visits.observer.request('control.step', { ticks: 20 });
    return (await height()) - low;
  };
  await expect.poll(lifted, kInTime).toBeGreaterThan(0.02);
  await visits.viewer.page.keyboard.press('b'); // the next one
  await expect.poll(async () => (await grabs())[0] !== held, kInTime).toBe(true);
  await visits.viewer.page.keyboard.press('Escape');
  await visits.viewer.until('#view:not([data-held-body])');
  await expect.poll(grabs, kInTime).toEqual([]);
});

it('tilts gravity by how a device is held, from how it was held at first', async () => {
  await takePhone();
  const lean = (beta: number, gamma: number): Promise<void> =>
    visits.viewer.page.evaluate(
      ([b, g]) => {
        window.dispatchEvent(
          new DeviceOrientationEvent('deviceorientation', { beta: b, gamma: g }),
        );
      },
      [beta, gamma] as const,
    );
  await visits.viewer.page.click('#gravity-device');
  await visits.viewer.until('#gravity-device[aria-pressed="true"]');
  await lean(40, 0);
  await lean(40, 30);
  const gravity = async (): Promise<number[]> =>
    (await visits.observer.request('session.join', {})).description.gravity;
  // 30 degrees to the right of the picture: half of gravity goes there.
  await expect
    .poll(async () => Math.hypot(...(await gravity()).slice(0, 2)), kInTime)
    .toBeGreaterThan(4.5);
  const [x, y, z] = await gravity();
  expect(Math.hypot(x!, y!, z!)).toBeCloseTo(9.81, 1);
  expect(x!).toBeGreaterThan(Math.abs(y!)); // the first view has x to the right
  await visits.viewer.page.click('#gravity-device');
  await lean(40, -30);
  await visits.viewer.page.click('#gravity-reset');
  await expect.poll(gravity, kInTime).toEqual([0, 0, -9.81]);
});

it('says where a device does not tell how it is held', async () => {
  await takePhone();
  await visits.viewer.page.click('#gravity-device');
  await visits.viewer.until('#notices li[data-level="error"]');
  expect(await visits.viewer.page.textContent('#notices')).toContain(
    'does not tell how it is held',
  );
});

it('tells density and mass of what is clicked', async () => {
  await visits.visit('rigid-stack');
  const { x, y } = await visits.viewer.findParticle();
  await visits.viewer.page.mouse.click(x, y);
  await visits.viewer.page.waitForSelector('#inspector:has-text("Mass")');
  const text = (await visits.viewer.page.textContent('#inspector')) ?? '';
  const name = /^(.*) · particle/.exec(text)![1]!;
  const { bodies, materials } = await visits.scene();
  const body = bodies.find((one) => one.name === name)!;
  const density = materials.find((one) => one.name === body.material)!.density!;
  const { shape } = body;
  const volume =
    shape.type === 'box'
      ? shape.size[0] * shape.size[1] * shape.size[2]
      : shape.type === 'sphere'
        ? (4 / 3) * Math.PI * shape.radius ** 3
        : NaN;
  expect(text).toContain(`Density${formatCount(density)} kg/m³`);
  const mass = Number(/Mass([\d.]+) kg/.exec(text)?.[1]);
  expect(mass / (density * volume)).toBeCloseTo(1, 2);
});
