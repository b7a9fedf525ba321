import { Color, Ray, Vector3 } from 'three';
import { expect, it } from 'vitest';
import { BodyKind } from '../../../web/client/index';
import type { Frame, SessionDescription } from '../../../web/client/index';
import { sharedUniforms } from '../../../web/viewer/view/bodies/shared_uniforms';
import type { Theme } from '../../../web/viewer/view/base/theme';
import { World } from '../../../web/viewer/view/world';

const kNames = ['stage', 'floor', 'shadow', 'grid', 'edge', 'wall', 'mark'];
const kTheme = Object.fromEntries(kNames.map((name) => [name, new Color()])) as unknown as Theme;

function described(epoch: number, bodies: number[], scene = 'pool'): SessionDescription {
  return {
    session: 's1',
    epoch,
    tick: 0,
    name: '',
    scene,
    title: '',
    playing: false,
    speed: 1,
    tick_seconds: 0.02,
    gravity: [0, 0, -9.81],
    vat: { min: [0, 0, 0], max: [1, 1, 1], lid: false },
    materials: [],
    bodies: bodies.map((body) => ({
      body,
      name: String(body),
      kind: 'liquid',
      material: 'water',
      particles: 1,
      radius: 0.01,
    })),
  };
}

/** A frame with one particle per body at this x. */
function frame(epoch: number, places: Record<number, number>): Frame {
  return {
    header: { epoch, time: 0, origin: [0, 0, 0], quantum: 0.1, attributeQuanta: [] },
    blocks: Object.entries(places).map(([body, x]) => ({
      kind: BodyKind.liquid,
      body: Number(body),
      positions: Uint16Array.of(x, 0, 0),
      numbers: undefined,
      attributes: [],
    })),
  } as unknown as Frame;
}

const at = (world: World, x: number): number | undefined =>
  world.pick(new Ray(new Vector3(0.1 * x, 0, 5), new Vector3(0, 0, -1)))?.body;

it('keeps bodies in sight while others come and go, until the next frame moves them', () => {
  const world = new World(kTheme, sharedUniforms());
  world.describe(described(1, [1, 2]));
  world.show(frame(1, { 1: 2, 2: 4 }));
  expect([at(world, 2), at(world, 4)]).toEqual([1, 2]);
  world.describe(described(2, [1, 3]));
  expect([at(world, 2), at(world, 4)]).toEqual([1, undefined]);
  expect(world.show(frame(1, { 1: 6 }))).toBe(false);
  world.show(frame(2, { 1: 6, 3: 8 }));
  world.phase = 0; // no motion from the previously displayed state
  expect([at(world, 2), at(world, 6), at(world, 8)]).toEqual([undefined, 1, 3]);
});

it('shows nothing of another scene, though its bodies have the same numbers', () => {
  const world = new World(kTheme, sharedUniforms());
  world.describe(described(1, [1]));
  world.show(frame(1, { 1: 2 }));
  world.describe(described(2, [1], 'another'));
  expect(at(world, 2)).toBeUndefined();
});

it('frames rigid bodies at their poses in the first frame', () => {
  const world = new World(kTheme, sharedUniforms());
  const description = described(1, []);
  const body = { body: 1, name: 'ball', kind: 'rigid' as const, material: 'wood' };
  const ball = { ...body, particles: 1, radius: 0.1, local_positions: [0, 0, 0] };
  world.describe({ ...description, bodies: [ball] });
  const pose = { position: [0.5, 0.5, 0.6], orientation: [1, 0, 0, 0] };
  const { header } = frame(1, {});
  world.show({ header, blocks: [{ kind: BodyKind.rigid, body: 1, ...pose }] } as unknown as Frame);
  expect(world.framed.max.z).toBeCloseTo(0.6 + 0.1 + 0.08); // the top of the ball, and some space
});
