import { readFileSync, readdirSync } from 'node:fs';
import { describe, expect, it } from 'vitest';
import type { Scene, SceneMaterial } from '../../../web/client/index';
import { materialsFor, spacingFor } from '../../../web/viewer/build/body_choice';
import { newInterfaces, withNewMaterials } from '../../../web/viewer/build/new_materials';

const kFolder = new URL('../../../protocol/scenes/', import.meta.url);
const shipped = (name: string): Scene =>
  JSON.parse(readFileSync(new URL(name, kFolder), 'utf8')) as Scene;
const names = readdirSync(kFolder).filter((name) => name.endsWith('.json'));
const model = shipped('sliding-vat-liquid.json');
const material = (scene: Scene, name: string): SceneMaterial =>
  scene.materials.find((one) => one.name === name)!;

describe('materials that a scene lacks', () => {
  it.each(names)('are there for each kind of body: %s', (name) => {
    const scene = withNewMaterials(shipped(name));
    for (const kind of ['liquid', 'deformable', 'rigid'] as const) {
      expect(materialsFor(scene, kind).length, kind).toBeGreaterThan(0);
    }
    const all = scene.materials.map((one) => one.name);
    expect(new Set(all).size).toBe(all.length);
    expect(scene.materials.slice(0, -1)).toEqual(
      expect.arrayContaining(shipped(name).materials.slice(0, -1)),
    );
  });

  it('are those of the model by default', () => {
    const bare = { ...model, materials: [] };
    expect(withNewMaterials(bare).materials).toEqual(model.materials);
    expect(newInterfaces(bare, material(model, 'jelly'))).toEqual([]);
    expect(withNewMaterials(model).materials).toEqual(model.materials);
  });

  it.each(names)('have supports of two spacings, and one for all liquids: %s', (name) => {
    const before = shipped(name);
    const scene = withNewMaterials(before);
    const radii = materialsFor(scene, 'liquid').map(({ liquid }) => liquid!.support_radius);
    expect(new Set(radii).size).toBe(1);
    if (materialsFor(before, 'liquid').length > 0) return;
    expect(radii[0]! / spacingFor(scene, 'liquid', 'water')).toBeCloseTo(2, 2);
  });

  /** The quantities that determine the stability of a step must not exceed those of the model. */
  it.each(names)('are followed by the steps of the scene: %s', (name) => {
    const before = shipped(name);
    const scene = withNewMaterials(before);
    const step = before.numerics?.step ?? 0.001;
    const isNew = (what: string): boolean => !before.materials.some((one) => one.name === what);
    if (isNew('jelly')) {
      const jelly = material(scene, 'jelly');
      const spacing = spacingFor(scene, 'deformable', 'jelly');
      const mass = jelly.density! * spacing ** (scene.dimensions ?? 3);
      const { stiffness, damping = 0 } = jelly.springs!.structural!;
      // The model has 600 N/m, 1 N s/m, 2 ms, and 500 kg/m³ at 5 cm. Constants have three digits.
      expect((stiffness * step ** 2) / mass).toBeLessThan(1.01 * ((600 * 0.002 ** 2) / 0.0625));
      expect((damping * step) / mass).toBeLessThan(1.01 * ((1 * 0.002) / 0.0625));
      expect(stiffness).toBeGreaterThan(0);
    }
    if (isNew('water')) {
      const { stiffness, viscosity, support_radius } = material(scene, 'water').liquid!;
      expect((Math.sqrt(stiffness) * step) / support_radius).toBeLessThan(1.01 * 0.4);
      expect(stiffness).toBeLessThanOrEqual(400);
      const own = material(model, 'water').liquid!;
      const most = (own.viscosity * model.numerics!.step!) / own.support_radius ** 2;
      expect((viscosity * step) / support_radius ** 2).toBeLessThan(1.01 * most);
    }
  });

  it('meet others no more stiffly than their steps follow', () => {
    const stack = shipped('rigid-stack.json');
    const scene = withNewMaterials(stack);
    // The model has 3000 N/m for 62.5 g and 2 ms. Here the mass is equal and the step is 1 ms.
    expect(newInterfaces(stack, material(scene, 'jelly'))).toEqual(
      ['wood', 'stone', 'jelly', 'vat'].map((other) => ({
        materials: ['jelly', other],
        stiffness: 12000,
        damping: 8,
      })),
    );
    expect(newInterfaces(stack, material(scene, 'water'))).toEqual([]); // interacts by its pressure
    const gas: Scene = { ...stack, pressure_solver: 'gas' };
    const met = newInterfaces(gas, material(scene, 'water')).map(({ materials }) => materials[1]);
    expect(met).toEqual(['wood', 'stone', 'vat']);
    const projecting = shipped('brick-wall.json');
    expect(newInterfaces(projecting, material(withNewMaterials(projecting), 'jelly'))).toEqual([]);
  });
});
