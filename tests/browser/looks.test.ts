import { describe, expect, it } from 'vitest';
import { differenceFromReference, pixelsOf, statisticsOf } from './pixels';
import type { Region } from './pixels';
import type { Look } from './viewer';
import { Visits } from './visits';

/** How the view shows what the session holds: pictures of states that stand still. */
const visits = new Visits();

/** Pictures of one state on two machines differ by rounding at edges alone: some pixels in 100. */
const kAlike = 2;

/** The least number of pixels that a mark takes. */
const kMark = 1000;

/** Of the view of the dam break at its start: in the column of water, and beside it. */
const kWater = { left: 0.14, top: 0.4, right: 0.22, bottom: 0.55 };
const kAir = { left: 0.5, top: 0.3, right: 0.7, bottom: 0.5 };

/** The page with these settings of the view, at this tick of the scene, which stands still. */
async function look(scene: string, tick: number, view: string, looks: Look = {}): Promise<void> {
  await visits.visit(scene, { tick, hash: `#view=${view}`, ...looks });
  await visits.viewer.page.click('#view-details > summary');
  if (view.includes('liquid:surface')) await untilSurfaces(1);
}

/** Waits for surfaces around particles, which are made beside the page. */
async function untilSurfaces(least: number): Promise<void> {
  await visits.viewer.page.waitForFunction((count) => {
    return Number(document.getElementById('view')?.dataset.surfaces) >= count;
  }, least);
}

describe.each(['fluid', 'surface', 'splats', 'particles'])('a liquid as %s', (style) => {
  it.each(['light', 'dark'] as const)('is blue before a %s scene', async (colorScheme) => {
    await look('dam-break', 0, `liquid:${style}`, { colorScheme });
    expect(await visits.viewer.said('liquid')).toBe(style);
    const picture = await pixelsOf(visits.viewer);
    const water = statisticsOf(picture, kWater);
    const air = statisticsOf(picture, kAir);
    expect(water.blue - water.red).toBeGreaterThan(50);
    expect(Math.abs(air.blue - air.red)).toBeLessThan(25);
    expect(air.green > 127).toBe(colorScheme === 'light');
  });

  it('looks as it did', async () => {
    await look('sliding-vat-liquid', 40, `liquid:${style}`);
    expect(await differenceFromReference(visits.viewer, `liquid-${style}`)).toBeLessThan(kAlike);
  });
});

it('falls back to splats where the processor draws, and says so', async () => {
  await look('dam-break', 0, '');
  expect(await visits.viewer.said('liquid')).toBe('splats');
  expect(await visits.viewer.page.textContent('#view-notice')).toContain('processor');
});

it('keeps what was chosen when the page is loaded again', async () => {
  await look('dam-break', 0, '');
  await visits.viewer.page.selectOption('#view-liquid', 'particles');
  expect(await visits.viewer.said('liquid')).toBe('particles');
  await visits.viewer.page.goto('about:blank');
  await visits.viewer.page.goto(visits.server.url);
  await visits.viewer.until('#view[data-liquid="particles"]');
  expect(await visits.viewer.page.inputValue('#view-liquid')).toBe('particles');
});

/** The greatest speed of a particle [m/s]. */
async function greatestSpeed(): Promise<number> {
  const { bodies } = await visits.observer.request('state.query', {});
  return Math.max(...bodies.flatMap(({ velocities }) => velocities.map((v) => Math.hypot(...v))));
}

it('colours by speed, and its legend tells the speeds that there are', async () => {
  await look('dam-break', 12, 'colour:speed');
  await visits.viewer.until('#colour-legend[data-max]');
  const fastest = await greatestSpeed();
  const most = async (): Promise<number> =>
    Number(await visits.viewer.page.getAttribute('#colour-legend', 'data-max'));
  await expect.poll(most).toBeGreaterThan(fastest - 0.03);
  expect(await most()).toBeLessThan(fastest + 0.03);
  expect(await visits.viewer.page.textContent('#colour-legend')).toContain('m/s');
  const picture = await pixelsOf(visits.viewer);
  const front = statisticsOf(picture, { left: 0.46, top: 0.68, right: 0.52, bottom: 0.72 });
  expect(Math.min(front.red, front.green) - front.blue).toBeGreaterThan(40); // yellow: fast
  const back = statisticsOf(picture, { left: 0.12, top: 0.5, right: 0.18, bottom: 0.6 });
  expect(back.blue - back.red).toBeGreaterThan(5); // blue: slow
  await visits.viewer.page.selectOption('#view-map', 'cividis');
  await visits.viewer.page.fill('#view-from', '0');
  await visits.viewer.page.fill('#view-to', '100');
  await visits.viewer.page.press('#view-to', 'Enter');
  await visits.viewer.until('#colour-legend[data-max="100"]');
  const dark = statisticsOf(await pixelsOf(visits.viewer), {
    left: 0.46,
    top: 0.68,
    right: 0.52,
    bottom: 0.72,
  });
  expect(dark.blue - dark.red).toBeGreaterThan(0); // the least of cividis
});

/** Greater numbers have more of it in the colours that are used at first. */
async function greenAt(region: Region): Promise<number> {
  return statisticsOf(await pixelsOf(visits.viewer), region).green;
}

it.each([
  ['pressure', 'Pa', [980, 40_000]], // of water 0.1 m and 4 m deep
  ['density', 'kg/m³', [1000, 1100]],
] as const)('colours by %s', async (name, unit, [low, high]) => {
  await look('dam-break', 12, `colour:${name}`);
  await visits.viewer.until('#colour-legend[data-max]');
  expect(await visits.viewer.page.textContent('#colour-legend')).toContain(unit);
  const most = Number(await visits.viewer.page.getAttribute('#colour-legend', 'data-max'));
  expect(most).toBeGreaterThan(low);
  expect(most).toBeLessThan(high);
  // Liquid deep within the column of water, and at its surface, which is under no pressure.
  const deep = await greenAt({ left: 0.16, top: 0.6, right: 0.26, bottom: 0.66 });
  const surface = await greenAt({ left: 0.2, top: 0.36, right: 0.28, bottom: 0.4 });
  expect(deep).toBeGreaterThan(surface + 30);
});

it('tells bodies or their kinds by colours, which need no legend', async () => {
  await look('rigid-stack', 0, 'colour:body,solids:particles');
  expect(await visits.viewer.page.isVisible('#colour-legend')).toBe(false);
  const hues = async (): Promise<number> => {
    const { data } = await pixelsOf(visits.viewer);
    const seen = new Map<number, number>();
    for (let i = 0; i < data.length; i += 3) {
      const [red, green, blue] = data.slice(i, i + 3) as [number, number, number];
      const greatest = Math.max(red, green, blue);
      const chroma = greatest - Math.min(red, green, blue);
      if (chroma < 40) continue; // grey: the vat
      const sixth =
        greatest === red
          ? (green - blue) / chroma
          : greatest === green
            ? 2 + (blue - red) / chroma
            : 4 + (red - green) / chroma;
      const hue = (Math.round(2 * sixth) + 12) % 12;
      seen.set(hue, (seen.get(hue) ?? 0) + 1);
    }
    return [...seen.values()].filter((count) => count > 10).length;
  };
  const byBody = await hues();
  await visits.viewer.page.selectOption('#view-colour', 'kind');
  const byKind = await hues();
  expect(byKind).toBeLessThan(byBody);
  expect(await visits.viewer.page.isVisible('#colour-legend')).toBe(false);
});

it('cuts away what is beyond a plane', async () => {
  await look('dam-break', 0, 'clip:z,clipAt:0.4,liquid:particles');
  const above = { left: 0.14, top: 0.36, right: 0.2, bottom: 0.42 };
  const cut = statisticsOf(await pixelsOf(visits.viewer), above);
  expect(Math.abs(cut.blue - cut.red)).toBeLessThan(25);
  await visits.viewer.page.selectOption('#view-clip', 'off');
  const whole = statisticsOf(await pixelsOf(visits.viewer), above);
  expect(whole.blue - whole.red).toBeGreaterThan(50);
});

it('moves between frames, and tells how much later it is', async () => {
  await look('dam-break', 0, 'smooth:on,liquid:particles');
  await visits.observer.request('control.play', {});
  await visits.viewer.untilTick(10);
  await visits.viewer.page.waitForFunction(() =>
    document.getElementById('view-options')?.textContent?.includes('ms later'),
  );
  await visits.observer.request('control.pause', {});
  const { tick } = await visits.observer.request('state.query', {});
  await visits.viewer.untilTick(tick, tick);
  const before = await visits.viewer.picture();
  await visits.viewer.page.selectOption('#view-smooth', 'off');
  expect(await visits.viewer.difference(before, await visits.viewer.picture())).toBeLessThan(20);
});

it.each([
  ['arrows', 'Arrows point to where'],
  ['axes', ''],
  ['cells', 'cm wide'],
] as const)('shows and hides %s', async (mark, words) => {
  await look('sliding-vat-liquid', 40, 'liquid:splats');
  await visits.observer.request('control.step', { ticks: 1 }); // velocities are known from two frames
  await visits.viewer.untilTick(41, 41);
  const without = await visits.viewer.picture();
  await visits.viewer.page.check(`#view-${mark}`);
  const changed = await visits.viewer.difference(without, await visits.viewer.picture());
  expect(changed).toBeGreaterThan(kMark);
  expect(changed).toBeLessThan(40 * kMark); // lines, and not the picture
  expect(await visits.viewer.page.textContent('#view-options')).toContain(words);
  await visits.viewer.page.uncheck(`#view-${mark}`);
  expect(await visits.viewer.difference(without, await visits.viewer.picture())).toBeLessThan(20);
});

it('points arrows where the liquid goes', async () => {
  await look('dam-break', 5, 'liquid:particles');
  await visits.observer.request('control.step', { ticks: 1 });
  await visits.viewer.untilTick(6, 6);
  const kFalling = { left: 0.1, top: 0.42, right: 0.25, bottom: 0.5 };
  const without = statisticsOf(await pixelsOf(visits.viewer), kFalling);
  await visits.viewer.page.check('#view-arrows');
  const falling = statisticsOf(await pixelsOf(visits.viewer), kFalling);
  expect(falling.blue).toBeLessThan(without.blue - 10); // dark ink over the water
});

it('gives bodies smooth skins', async () => {
  await look('sliding-vat-liquid', 1, 'liquid:particles');
  const before = await visits.viewer.picture();
  await visits.viewer.page.selectOption('#view-solids', 'skin');
  await untilSurfaces(5); // two deformable bodies, three rigid ones
  const skins = await visits.viewer.picture();
  expect(await visits.viewer.difference(before, skins)).toBeGreaterThan(3000);
  expect(await differenceFromReference(visits.viewer, 'skins')).toBeLessThan(kAlike);
  await visits.viewer.page.selectOption('#view-solids', 'both');
  await untilSurfaces(10);
  expect(await visits.viewer.difference(skins, await visits.viewer.picture())).toBeGreaterThan(
    3000,
  );
});

it('draws springs by their strain, and says how far they are strained', async () => {
  await look('hammock', 40, 'solids:particles');
  const without = await visits.viewer.picture();
  await visits.viewer.page.check('#view-springs');
  await visits.viewer.page.waitForFunction(
    () => Number(document.getElementById('view')?.dataset.links?.split(' ')[0]) > 50,
  );
  const { springs } = await visits.observer.request('state.connections', { most: 10_000 });
  const most = Math.max(...springs.strains.map(Math.abs));
  const told = /by up to ([\d.]+) %/.exec(
    (await visits.viewer.page.textContent('#links-words')) ?? '',
  );
  expect(Number(told?.[1]) / (100 * most)).toBeCloseTo(1, 1);
  expect(await visits.viewer.difference(without, await visits.viewer.picture())).toBeGreaterThan(
    kMark,
  );
  await visits.viewer.page.uncheck('#view-springs');
  await visits.viewer.until('#view[data-links="0 0"]');
  expect(await visits.viewer.difference(without, await visits.viewer.picture())).toBeLessThan(20);
});

it('draws contacts by their force', async () => {
  await look('rigid-stack', 120, '');
  await visits.viewer.page.check('#view-contacts');
  const { contacts } = await visits.observer.request('state.connections', {});
  expect(contacts.total).toBeGreaterThan(0);
  await visits.viewer.page.waitForFunction(
    (total) => Number(document.getElementById('view')?.dataset.links?.split(' ')[1]) === total,
    contacts.total,
  );
  expect(await visits.viewer.page.textContent('#links-words')).toMatch(/up to [\d.e]+ N/);
});

it('colours by the force on particles', async () => {
  await look('dam-break', 12, 'colour:force,liquid:particles');
  await visits.observer.request('control.step', { ticks: 1 });
  await visits.viewer.untilTick(13, 13);
  await visits.viewer.until('#colour-legend[data-max]');
  expect(await visits.viewer.page.textContent('#colour-legend')).toContain('m/s²');
  const most = async (): Promise<number> =>
    Number(await visits.viewer.page.getAttribute('#colour-legend', 'data-max'));
  await expect.poll(most, { timeout: 60_000 }).toBeGreaterThan(5); // what falls has 9.81
});
