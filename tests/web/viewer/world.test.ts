import { Mesh, PlaneGeometry, Ray, ShaderMaterial, Vector3 } from 'three';
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

/** A world with one body of one particle, in a vat of 1 m. */
function worldWith(kind: 'rigid' | 'liquid', radius: number, lid = false): World {
  const world = new World(kTheme, sharedUniforms());
  const local = kind === 'rigid' ? { local_positions: [0, 0, 0] } : {};
  const body = { body: 1, name: 'body', kind, material: 'wood', particles: 1, radius, ...local };
  world.describe(described({}, { bodies: [body], vat: { min: [0, 0, 0], max: [1, 1, 1], lid } }));
  return world;
}

it('frames the space around rigid bodies, and follows them', () => {
  const world = worldWith('rigid', 0.1);
  const show = (x: number, time: number): void => {
    const { header } = frameOf(1, {});
    const pose = { position: [x, 0.5, 0.1], orientation: [1, 0, 0, 0] };
    const block = { kind: BodyKind.rigid, body: 1, ...pose };
    world.show({ header: { ...header, time }, blocks: [block] } as unknown as Frame);
  };
  show(0.2, 0);
  expect(world.framed.max.x).toBeLessThan(0.5);
  show(0.8, 0.1);
  expect(world.framed.max.x).toBeGreaterThan(0.9);
  expect(world.framed.min.x).toBeLessThan(0.2); // it shrinks slowly
  show(0.8, 20);
  expect(world.framed.min.x).toBeGreaterThan(0.5);
});

it('draws the ground before the floor of the vat, which covers it', () => {
  const meshes: Mesh[] = [];
  worldWith('rigid', 0.1).group.traverse((object) => {
    if (object instanceof Mesh) meshes.push(object);
  });
  const isGround = ({ material }: Mesh): boolean =>
    material instanceof ShaderMaterial && 'ground' in material.uniforms;
  const order = (mesh: Mesh | undefined): number | undefined => mesh?.renderOrder;
  const floor = meshes.find(({ geometry }) => geometry instanceof PlaneGeometry);
  expect(order(meshes.find(isGround))).toBeLessThan(order(floor)!);
});

const width = ({ framed }: World): number => framed.max.x - framed.min.x;

it('frames the whole vat if a liquid covers the floor, but the space around a drop', () => {
  const widths = [0, 6].map((height) => {
    const world = worldWith('liquid', 0.1);
    const frame = frameOf(1, { 1: 4 });
    (frame.blocks[0] as { positions: Uint16Array }).positions[2] = height; // in 0.1 m
    world.show(frame);
    return width(world);
  });
  expect(widths[0]).toBe(1);
  expect(widths[1]).toBeCloseTo(0.25, 9);
});

it('frames the whole vat if it is closed and has no liquid', () => {
  const world = worldWith('rigid', 0.1, true);
  const { header } = frameOf(1, {});
  const pose = { position: [0.2, 0.5, 0.1], orientation: [1, 0, 0, 0] };
  world.show({ header, blocks: [{ kind: BodyKind.rigid, body: 1, ...pose }] } as unknown as Frame);
  expect(width(world)).toBe(1);
});
