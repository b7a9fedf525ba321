import { Ray, Vector3 } from 'three';
import { expect, it } from 'vitest';
import { BodyKind } from '../../../web/client/index';
import type { Frame } from '../../../web/client/index';
import { sharedUniforms } from '../../../web/viewer/view/bodies/shared_uniforms';
import { World } from '../../../web/viewer/view/world';
import { described, frameOf, kTheme } from '../described';

const at = (world: World, x: number): number | undefined =>
  world.pick(new Ray(new Vector3(0.1 * x, 0, 5), new Vector3(0, 0, -1)))?.body;

it('keeps bodies in sight while others come and go, until the next frame moves them', () => {
  const world = new World(kTheme, sharedUniforms());
  world.describe(described({ 1: '', 2: '' }));
  world.show(frameOf(1, { 1: 2, 2: 4 }));
  expect([at(world, 2), at(world, 4)]).toEqual([1, 2]);
  world.describe(described({ 1: '', 3: '' }, { epoch: 2 }));
  expect([at(world, 2), at(world, 4)]).toEqual([1, undefined]);
  expect(world.show(frameOf(1, { 1: 6 }))).toBe(false);
  world.show(frameOf(2, { 1: 6, 3: 8 }));
  world.phase = 0; // no motion from the previously displayed state
  expect([at(world, 2), at(world, 6), at(world, 8)]).toEqual([undefined, 1, 3]);
});

it('shows nothing of another scene, though its bodies have the same numbers', () => {
  const world = new World(kTheme, sharedUniforms());
  world.describe(described({ 1: '' }));
  world.show(frameOf(1, { 1: 2 }));
  world.describe(described({ 1: '' }, { epoch: 2, scene: 'another' }));
  expect(at(world, 2)).toBeUndefined();
});

it('frames rigid bodies at their poses in the first frame', () => {
  const world = new World(kTheme, sharedUniforms());
  const body = { body: 1, name: 'ball', kind: 'rigid' as const, material: 'wood' };
  const ball = { ...body, particles: 1, radius: 0.1, local_positions: [0, 0, 0] };
  world.describe(described({}, { bodies: [ball] }));
  const pose = { position: [0.5, 0.5, 0.6], orientation: [1, 0, 0, 0] };
  const { header } = frameOf(1, {});
  world.show({ header, blocks: [{ kind: BodyKind.rigid, body: 1, ...pose }] } as unknown as Frame);
  expect(world.framed.max.z).toBeCloseTo(0.6 + 0.1 + 0.08); // the top of the ball, and some space
});
