import { describe, expect, it } from 'vitest';
import type { BodyState, Scene, SceneBody, Vector } from '../../../web/client/index';
import { kMostParticles, recordOf } from '../../../web/viewer/build/body_record';

const made: SceneBody = {
  name: 'a',
  kind: 'deformable',
  material: 'jelly',
  spacing: 0.1,
  shape: { type: 'box', size: [1, 1, 1] },
  position: [0, 0, 2],
};
const scene = { materials: [], bodies: [made] } as unknown as Scene;
const at = (n: number): Vector => [n, 2 * n, 3];
const stateOf = (count: number): BodyState => ({
  body: 7,
  name: 'a',
  kind: 'deformable',
  positions: Array.from({ length: count }, (_, n) => at(n)),
  velocities: Array.from({ length: count }, () => [0, 0, -1]),
});

describe('the record of a body', () => {
  it('has its particles, and their velocities', () => {
    const state = stateOf(3);
    const { positions, velocities } = state;
    expect(recordOf(scene, made, state)).toEqual({
      record: { body: made, state: { positions, velocities } },
      isWhole: true,
    });
  });

  it('has the pose of a rigid body of any size', () => {
    const pose = {
      center_of_mass: at(1),
      orientation: [0, 1, 0, 0] as [number, number, number, number],
      velocity: at(2),
      angular_velocity: at(3),
    };
    const body: SceneBody = { ...made, kind: 'rigid' };
    const state: BodyState = { ...stateOf(kMostParticles + 1), kind: 'rigid', ...pose };
    expect(recordOf(scene, body, state)).toEqual({
      record: { body, state: pose },
      isWhole: true,
    });
  });

  it('lists the particles if some were added or removed', () => {
    const body: SceneBody = { ...made, kind: 'liquid', velocity: [1, 0, 0] };
    const state = stateOf(2);
    const { positions, velocities } = state;
    const flowing = { ...scene, emitters: [{ body: 'a' }] } as unknown as Scene;
    const { position, velocity, ...rest } = body;
    expect([position, velocity]).toBeDefined();
    expect(recordOf(flowing, body, state).record).toEqual({
      body: { ...rest, shape: { type: 'particles', positions, velocities } },
    });
    const elsewhere = { ...scene, emitters: [{ body: 'b' }] } as unknown as Scene;
    expect(recordOf(elsewhere, body, state).record.body).toBe(body);
  });

  it('has the position but no deformation if a message is too small for it', () => {
    expect(recordOf(scene, made, stateOf(kMostParticles)).isWhole).toBe(true);
    const { record, isWhole } = recordOf(scene, made, stateOf(kMostParticles + 1));
    expect(isWhole).toBe(false);
    expect(record).toEqual({
      body: { ...made, position: [kMostParticles / 2, kMostParticles, 3] },
    });
  });
});
