import { describe, expect, it } from 'vitest';
import type { Scene, SceneInterface } from '../../../web/client/index';
import {
  fieldsOf,
  interfaceOf,
  ownInterface,
  withConstant,
  withLaw,
} from '../../../web/viewer/build/parameters/interface_fields';

const scene = {
  materials: [
    { name: 'wood' },
    { name: 'ice' },
    { name: 'water', liquid: { stiffness: 1, viscosity: 1, support_radius: 0.1 } },
  ],
  default_interface: { stiffness: 700, damping: 3 },
  interfaces: [{ materials: ['ice', 'vat'], law: 'projection', friction: 0.1 }],
} as unknown as Scene;
const names = (one: SceneInterface, of = scene): string[] =>
  fieldsOf(of, one).map(({ name }) => name);

describe('the interface of two materials', () => {
  it('is that of the scene, in either order of the materials', () => {
    expect(interfaceOf(scene, ['vat', 'ice'])).toBe(scene.interfaces![0]);
    expect(ownInterface(scene, ['ice', 'wood'])).toBeUndefined();
  });

  it('is the default if the scene has no interface', () => {
    expect(interfaceOf(scene, ['ice', 'wood'])).toEqual({
      materials: ['ice', 'wood'],
      stiffness: 700,
      damping: 3,
    });
    const bare = { ...scene } as Partial<Scene>;
    delete bare.default_interface;
    expect(interfaceOf(bare as Scene, ['wood', 'vat'])).toMatchObject({
      stiffness: 1000,
      damping: 1,
    });
  });

  it('has the law sph if one material is a liquid, except with the solver gas', () => {
    expect(interfaceOf(scene, ['water', 'vat']).law).toBe('sph');
    const gas: Scene = { ...scene, pressure_solver: 'gas' };
    expect(interfaceOf(gas, ['wood', 'water']).law).toBeUndefined();
  });

  it('has the constants of its law', () => {
    const materials: [string, string] = ['wood', 'ice'];
    expect(names({ materials, stiffness: 1 })).toEqual([
      'stiffness',
      'damping',
      'friction',
      'threshold',
    ]);
    expect(names({ materials, stiffness: 1, restitution: 0.5 })).toContain('restitution');
    expect(names({ materials, stiffness: 1, restitution: 0.5 })).not.toContain('damping');
    expect(names({ materials, law: 'projection' })).not.toContain('stiffness');
    expect(names({ materials, law: 'lennard_jones', stiffness: 1 })).toContain('reach');
    expect(names({ materials, law: 'sph' })).toEqual([]);
    const tense = structuredClone(scene);
    tense.materials[2]!.liquid!.surface_tension = 0.07;
    expect(names({ materials, law: 'sph' }, tense)).toEqual(['contact_angle']);
  });

  it('keeps the common members of its laws', () => {
    const ice = interfaceOf(scene, ['ice', 'vat']);
    const penalty = withLaw(scene, ice, 'penalty');
    expect(penalty).toEqual({
      materials: ['ice', 'vat'],
      law: 'penalty',
      stiffness: 700,
      friction: 0.1,
    });
    expect(withLaw(scene, penalty, 'lennard_jones')).toEqual({
      materials: ['ice', 'vat'],
      law: 'lennard_jones',
      stiffness: 700,
    });
    const near = withConstant(penalty, 'threshold', 0.2);
    expect(near).toEqual({ ...penalty, threshold: 0.2 });
    expect(withLaw(scene, near, 'projection')).toMatchObject({ friction: 0.1, threshold: 0.2 });
    expect(withConstant(near, 'threshold', undefined)).toEqual(penalty);
    expect(withLaw(scene, near, 'sph')).toEqual({ materials: ['ice', 'vat'], law: 'sph' });
  });
});
