import { beforeEach, describe, expect, it } from 'vitest';
import { differenceFromReference, pixelsOf, statisticsOf } from './support/pixels';
import type { Pixels, Region } from './support/pixels';
import type { Look } from './support/viewer';
import { kInTime, Visits } from './support/visits';

/** Rendering of the session: pictures of states at rest. */
const visits = new Visits();

/**
 * Pictures of one state on two machines differ only by rounding at edges, in some pixels of 100.
 */
const kAlike = 2;

/** Minimum number of pixels of a mark. */
const kMark = 250;

/** Maximum number of pixels that differ without a change. */
const kSame = 20;

/** Regions of the dam break's view at its start: in the column of water, and next to it. */
const kWater = { left: 0.14, top: 0.4, right: 0.22, bottom: 0.55 };
const kAir = { left: 0.5, top: 0.3, right: 0.7, bottom: 0.5 };
const kStyles = ['fluid', 'surface', 'splats', 'particles'];

/** The page's scene and tick after the last test. */
let place = '';

/**
 * The last two frames of the page have successive ticks, from which foam and velocities follow. A
 * slow page can skip earlier ones.
 */
async function visit(scene: string, tick: number, view = '', look: Look = {}): Promise<void> {
  place = '';
  await visits.visit(scene, { tick: Math.max(tick - 1, 0), view, ...look });
  if (tick === 0) return;
  await visits.observer.request('control.step', { ticks: 1 });
  await visits.viewer.untilTick(tick, tick);
  await visits.untilWhole();
}

/** Shows the scene at this tick before each test of a group. A test may step it once. */
function stayAt(scene: string, tick: number, look: Look = {}): void {
  beforeEach(async () => {
    const there = JSON.stringify([scene, tick, look]);
    if (place !== there || !visits.isOpen) await visit(scene, tick, '', look);
    else await visits.set('');
    place = there;
  });
}

const statistics = async (region: Region) => statisticsOf(await pixelsOf(visits.viewer), region);
const textOf = async (id: string): Promise<string> =>
  (await visits.viewer.page.textContent(`#${id}`)) ?? '';
const most = async (): Promise<number> =>
  Number(await visits.viewer.page.getAttribute('#colour-legend', 'data-max'));

/** Returns the number of surfaces around particles that the worker has made so far. */
const surfaces = async (): Promise<number> => Number((await visits.viewer.said('surfaces')) ?? 0);

/** Changes the view by `act`. Resolves after `count` more surfaces were made. */
async function untilSurfaces(count: number, act: () => Promise<unknown>): Promise<void> {
  const before = await surfaces();
  await act();
  await expect.poll(surfaces, kInTime).toBeGreaterThanOrEqual(before + count);
}

const setStyle = (style: string): Promise<unknown> =>
  style === 'surface'
    ? untilSurfaces(1, () => visits.set(`liquid:${style}`))
    : visits.set(`liquid:${style}`);

/** Returns the number of pixels that differ from a picture. */
const changeFrom = async (picture: string): Promise<number> =>
  visits.viewer.difference(picture, await visits.viewer.picture());

describe('the dam break at its start', () => {
  stayAt('dam-break', 0);

  it('is drawn as splats without a graphics card, with a notice', async () => {
    expect(await visits.viewer.said('liquid')).toBe('splats');
    expect(await textOf('view-notice')).toContain('without a graphics card');
  });

  it.each(kStyles)('is blue before a light and a dark scene, as %s', async (style) => {
    await setStyle(style);
    expect(await visits.viewer.said('liquid')).toBe(style);
    for (const colorScheme of ['dark', 'light'] as const) {
      await visits.viewer.page.emulateMedia({ colorScheme });
      let pixels: Pixels | undefined;
      const isLight = async (): Promise<boolean> => {
        pixels = await pixelsOf(visits.viewer);
        return statisticsOf(pixels, kAir).green > 127;
      };
      await expect.poll(isLight, kInTime).toBe(colorScheme === 'light');
      const water = statisticsOf(pixels!, kWater);
      const air = statisticsOf(pixels!, kAir);
      expect(water.blue - water.red, colorScheme).toBeGreaterThan(50);
      expect(Math.abs(air.blue - air.red), colorScheme).toBeLessThan(25);
    }
  });

  it('is cut beyond a plane', async () => {
    const above = { left: 0.14, top: 0.36, right: 0.2, bottom: 0.42 };
    const blue = async (): Promise<number> => {
      const { blue, red } = await statistics(above);
      return blue - red;
    };
    await visits.set('clip:z,clipAt:0.4,liquid:particles');
    await expect.poll(async () => Math.abs(await blue()), kInTime).toBeLessThan(25);
    await visits.viewer.page.selectOption('#view-clip', 'off', { force: true });
    await expect.poll(blue, kInTime).toBeGreaterThan(50);
  });
});

describe('the dam break in motion', () => {
  stayAt('dam-break', 12);
  const kFront = { left: 0.46, top: 0.68, right: 0.52, bottom: 0.72 };
  const kBack = { left: 0.12, top: 0.5, right: 0.18, bottom: 0.6 };

  it('is coloured by speed, and the legend has the present speeds', async () => {
    await visits.set('colour:speed');
    await visits.viewer.until('#colour-legend[data-max]');
    const { bodies } = await visits.observer.request('state.query', {});
    const speeds = bodies.flatMap(({ velocities }) => velocities.map((v) => Math.hypot(...v)));
    const fastest = Math.max(...speeds);
    await expect.poll(async () => Math.abs((await most()) - fastest), kInTime).toBeLessThan(0.03);
    expect(await textOf('colour-legend')).toContain('m/s');
    const yellow = async (): Promise<number> => {
      const { red, green, blue } = await statistics(kFront);
      return Math.min(red, green) - blue;
    };
    await expect.poll(yellow, kInTime).toBeGreaterThan(40); // fast
    const back = await statistics(kBack);
    expect(back.blue - back.red).toBeGreaterThan(5); // slow
    await visits.set('colour:speed,map:cividis,from:0,to:100');
    await visits.viewer.until('#colour-legend[data-max="100"]');
    await expect.poll(yellow, kInTime).toBeLessThan(0); // the minimum of cividis
  });

  it.each([
    ['pressure', 'Pa', [980, 40_000]], // of water at depths of 0.1 m and 4 m
    ['density', 'kg/m³', [1000, 1100]],
  ] as const)('is coloured by %s', async (name, unit, [low, high]) => {
    await visits.set(`colour:${name}`);
    await visits.viewer.until('#colour-legend[data-max]');
    await expect.poll(() => textOf('colour-legend'), kInTime).toContain(unit);
    await expect.poll(most, kInTime).toBeGreaterThan(low);
    expect(await most()).toBeLessThan(high);
    // Liquid deep in the column of water, and at its surface, where the pressure is zero. Larger
    // values are greener.
    const deeper = async (): Promise<number> => {
      const pixels = await pixelsOf(visits.viewer);
      return (
        statisticsOf(pixels, { left: 0.27, top: 0.62, right: 0.34, bottom: 0.7 }).green -
        statisticsOf(pixels, { left: 0.14, top: 0.36, right: 0.2, bottom: 0.38 }).green
      );
    };
    await expect.poll(deeper, kInTime).toBeGreaterThan(30);
  });

  it('is coloured by the force per mass', async () => {
    await visits.set('colour:force,liquid:particles');
    await expect.poll(() => textOf('colour-legend'), kInTime).toContain('m/s²');
    // A step before the subscription to forces has none: they follow from changes of velocities.
    const mostOfNextStep = async (): Promise<number> => {
      await visits.observer.request('control.step', { ticks: 1 });
      return most();
    };
    await expect.poll(mostOfNextStep, kInTime).toBeGreaterThan(5); // particles in free fall have 9.81
  });
});

describe('a scene with bodies of all kinds', () => {
  stayAt('sliding-vat-liquid', 40);

  it.each(kStyles)('looks as it did, with the liquid as %s', async (style) => {
    await setStyle(style);
    await visits.viewer.stillPicture();
    await expect
      .poll(() => differenceFromReference(visits.viewer, `liquid-${style}`), kInTime)
      .toBeLessThan(kAlike);
  });
});

describe('marks over a scene, at full resolution', () => {
  stayAt('sliding-vat-liquid', 40, { deviceScaleFactor: 1 });

  it.each([
    ['arrows', 'Arrows show the distance'],
    ['axes', ''],
    ['cells', 'cm wide'],
  ] as const)('shows and hides %s', async (mark, words) => {
    let without = '';
    // Two frames of different ticks are needed for velocities. A repeated frame has none.
    const shown = async (): Promise<number> => {
      const { tick } = await visits.observer.request('control.step', { ticks: 1 });
      await visits.set('liquid:splats');
      await visits.viewer.untilTick(tick, tick);
      without = await visits.viewer.stillPicture();
      await visits.set(`liquid:splats,${mark}:true`);
      return changeFrom(without);
    };
    await expect.poll(shown, kInTime).toBeGreaterThan(4 * kMark);
    expect(await changeFrom(without)).toBeLessThan(160 * kMark); // only the lines change
    expect(await textOf('view-options')).toContain(words);
    await visits.set('liquid:splats');
    await expect.poll(() => changeFrom(without), kInTime).toBeLessThan(kSame);
  });
});

it('points arrows in the direction of the liquid', async () => {
  await visit('dam-break', 5, 'liquid:particles');
  const kFalling = { left: 0.1, top: 0.42, right: 0.25, bottom: 0.5 };
  const darker = async (): Promise<number> => {
    const { tick } = await visits.observer.request('control.step', { ticks: 1 });
    await visits.set('liquid:particles');
    await visits.viewer.untilTick(tick, tick);
    await visits.viewer.stillPicture();
    const without = (await statistics(kFalling)).blue;
    await visits.set('liquid:particles,arrows:true');
    return without - (await statistics(kFalling)).blue;
  };
  await expect.poll(darker, kInTime).toBeGreaterThan(10); // dark ink over the water
});

it('draws bodies as their shapes, with shadows on the floor', async () => {
  await visit('deformable-drop', 0);
  const before = await visits.viewer.stillPicture();
  const shadow = await statistics({ left: 0.58, top: 0.67, right: 0.62, bottom: 0.71 });
  const floor = await statistics({ left: 0.32, top: 0.76, right: 0.36, bottom: 0.8 });
  expect(floor.green - shadow.green).toBeGreaterThan(30);
  await visits.set('solids:particles');
  await expect.poll(() => changeFrom(before), kInTime).toBeGreaterThan(3000);
  await visits.set('solids:shape');
  await expect.poll(() => changeFrom(before), kInTime).toBeLessThan(kSame);
});

it('gives bodies smooth skins', async () => {
  await visit('sliding-vat-liquid', 1, 'liquid:particles');
  const before = await visits.viewer.stillPicture();
  // Two deformable bodies, three rigid ones.
  await untilSurfaces(5, () => visits.set('liquid:particles,solids:skin'));
  await expect.poll(() => changeFrom(before), kInTime).toBeGreaterThan(750);
  await visits.viewer.stillPicture();
  await expect
    .poll(() => differenceFromReference(visits.viewer, 'skins'), kInTime)
    .toBeLessThan(kAlike);
  const skins = await visits.viewer.stillPicture();
  await untilSurfaces(5, () => visits.set('liquid:particles,solids:both'));
  await expect.poll(() => changeFrom(skins), kInTime).toBeGreaterThan(750);
});

/**
 * Returns the number of hues among the strong colours of the picture, in twelfths of the circle.
 */
async function hues(): Promise<number> {
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
}

it('distinguishes bodies or their kinds by colours without a legend', async () => {
  await visit('rigid-stack', 0, 'colour:body,solids:particles');
  expect(await visits.viewer.page.isVisible('#colour-legend')).toBe(false);
  await visits.viewer.stillPicture();
  const byBody = await hues();
  await visits.set('colour:kind,solids:particles');
  await expect.poll(hues, kInTime).toBeLessThan(byBody);
  expect(await visits.viewer.page.isVisible('#colour-legend')).toBe(false);
});

it('draws contacts by their force', async () => {
  await visit('rigid-stack', 120, 'contacts:true');
  const { contacts } = await visits.observer.request('state.connections', {});
  expect(contacts.total).toBeGreaterThan(0);
  await expect
    .poll(async () => Number((await visits.viewer.said('links'))?.split(' ')[1]), kInTime)
    .toBe(contacts.total);
  expect(await textOf('links-words')).toMatch(/up to [\d.e]+ N/);
});

it('draws springs by their strain, and gives the greatest strain', async () => {
  await visit('hammock', 40, 'solids:particles');
  const without = await visits.viewer.stillPicture();
  await visits.set('solids:particles,springs:true');
  const drawn = async (): Promise<number> =>
    Number((await visits.viewer.said('links'))?.split(' ')[0]);
  await expect.poll(drawn, kInTime).toBeGreaterThan(50);
  const { springs } = await visits.observer.request('state.connections', { most: 10_000 });
  const greatest = Math.max(...springs.strains.map(Math.abs));
  const told = /by up to ([\d.]+) %/.exec(await textOf('links-words'));
  expect(Number(told?.[1]) / (100 * greatest)).toBeCloseTo(1, 1);
  await expect.poll(() => changeFrom(without), kInTime).toBeGreaterThan(kMark);
  await visits.set('solids:particles');
  await visits.viewer.until('#view[data-links="0 0"]');
  await expect.poll(() => changeFrom(without), kInTime).toBeLessThan(kSame);
});

it('interpolates between frames, and shows the delay', async () => {
  await visit('dam-break', 0, 'smooth:on,liquid:particles');
  await visits.observer.request('control.play', {});
  await visits.viewer.untilTick(10);
  await expect.poll(() => textOf('view-options'), kInTime).toContain('a delay of');
  await visits.observer.request('control.pause', {});
  const { tick } = await visits.observer.request('state.query', {});
  await visits.viewer.untilTick(tick, tick);
  const before = await visits.viewer.stillPicture();
  await visits.set('smooth:off,liquid:particles');
  await expect.poll(() => changeFrom(before), kInTime).toBeLessThan(kSame);
});

it('keeps the view settings when the page is loaded again', async () => {
  await visit('dam-break', 0);
  const { page } = visits.viewer;
  await page.click('#view-details > summary');
  await page.selectOption('#view-liquid', 'particles');
  expect(await visits.viewer.said('liquid')).toBe('particles');
  await page.reload();
  await visits.viewer.until('#view[data-liquid="particles"]');
  expect(await page.inputValue('#view-liquid')).toBe('particles');
});
