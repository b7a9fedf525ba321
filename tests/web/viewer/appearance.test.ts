import { Mesh } from 'three';
import type { Color, ShaderMaterial } from 'three';
import { describe, expect, it } from 'vitest';
import type { Appearance, SessionDescription } from '../../../web/client/index';
import {
  kAbsorptionField,
  kAppearanceFields,
  withAppearance,
  withAppearanceOf,
} from '../../../web/viewer/build/parameters/appearance_fields';
import { absorptionLengthOf, kFinishes, lookOf } from '../../../web/viewer/view/base/appearance';
import { sharedUniforms } from '../../../web/viewer/view/bodies/shared_uniforms';
import { World } from '../../../web/viewer/view/world';
import { described, frameOf, kTheme } from '../described';
import format from '../../../protocol/schemas/scene_format.json';

const kSchema = format.$defs.appearance.properties;

const liquids = (honey: Appearance, water: Appearance): SessionDescription =>
  described(
    { 1: 'honey', 2: 'water' },
    {
      vat: { min: [0, 0, 0], max: [2, 1, 3], lid: false },
      materials: [
        { name: 'honey', appearance: honey },
        { name: 'water', appearance: water },
      ],
    },
  );

/** Returns the values of a uniform of the world's bodies. */
function uniformsOf(world: World, name: string): unknown[] {
  const groups = world.group.children.filter((child) => !child.matrixAutoUpdate);
  return groups.map((group) => {
    const mesh = group.children.find((child) => child instanceof Mesh) as Mesh;
    return (mesh.material as ShaderMaterial).uniforms[name]!.value as unknown;
  });
}

const hex = (colour: unknown): string => `#${(colour as Color).getHexString()}`;

describe('Appearance', () => {
  it('colours bodies by their material, and follows a change of the material', () => {
    const world = new World(kTheme, sharedUniforms());
    world.describe(liquids({ colour: '#f0a01e', roughness: 0.1 }, { colour: '#4fb4e0' }));
    expect(uniformsOf(world, 'colour').map(hex)).toEqual(['#f0a01e', '#4fb4e0']);
    expect(uniformsOf(world, 'roughness')).toEqual([0.1, 0.5]);
    world.describe(liquids({ colour: '#102030' }, { colour: '#4fb4e0', roughness: 0.5 }));
    expect(uniformsOf(world, 'colour').map(hex)).toEqual(['#102030', '#4fb4e0']);
    expect(uniformsOf(world, 'roughness')).toEqual([0.5, 0.5]);
    world.colour = 'body';
    expect(uniformsOf(world, 'colour').map(hex)).not.toContain('#102030');
  });

  it('relates the absorption of each liquid to that of the darkest', () => {
    const shared = sharedUniforms();
    const world = new World(kTheme, shared);
    world.describe(liquids({ opacity: 0.8 }, { absorption_length: 0.5 }));
    expect(world.fluid!.clarity).toBeCloseTo(0.25); // the vat's smallest width × (1.05 - 0.8)
    world.show(frameOf(1, { 1: 1, 2: 2 }));
    world.prepare();
    const { data, width } = shared.look.body_table.value!.image as {
      data: Float32Array;
      width: number;
    };
    expect(data[4 * width - 1]).toBeCloseTo(1);
    expect(data[8 * width - 1]).toBeCloseTo(0.5);
  });

  it('gives even opaque liquids an absorption length', () => {
    expect(absorptionLengthOf(lookOf({ opacity: 1 }), 2)).toBeCloseTo(0.1);
    expect(absorptionLengthOf(lookOf({ opacity: 1, absorption_length: 3 }), 2)).toBe(3);
  });

  it('has the finishes and the ranges of the schema', () => {
    expect(kSchema.finish.enum).toEqual([...kFinishes]);
    for (const { name, min, max } of kAppearanceFields) {
      const { minimum, maximum } = kSchema[name] as { minimum: number; maximum: number };
      expect([min, max]).toEqual([minimum, maximum]);
    }
    const { minimum, maximum } = format.$defs.length;
    expect([kAbsorptionField.min, kAbsorptionField.max]).toEqual([minimum, maximum]);
  });

  it('is edited member by member, and is absent without members', () => {
    const wood = { name: 'wood', density: 600 };
    const red = withAppearance(wood, 'colour', '#ff0000');
    expect(red).toEqual({ ...wood, appearance: { colour: '#ff0000' } });
    const matt = withAppearance(red, 'roughness', 1);
    expect(matt.appearance).toEqual({ colour: '#ff0000', roughness: 1 });
    expect(withAppearance(matt, 'colour', undefined).appearance).toEqual({ roughness: 1 });
    expect(withAppearance(red, 'colour', undefined)).toEqual(wood);
    expect(withAppearanceOf(matt, red)).toEqual(red);
    expect(withAppearanceOf(matt, wood)).toEqual(wood);
    expect(wood).toEqual({ name: 'wood', density: 600 });
  });

  it('is plain if the description has no appearance', () => {
    expect(lookOf(undefined)).toMatchObject({ metalness: 0, opacity: 1, finish: 0 });
  });
});
