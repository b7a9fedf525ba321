import { afterAll, beforeAll, expect, it } from 'vitest';
import type { BodyState, Scene, Vector } from '../../web/client/index';
import { makeBody, materialsFor } from '../../web/viewer/build/body_choice';
import { newInterfaces, withNewMaterials } from '../../web/viewer/build/new_materials';
import { Observer } from './support/observer';
import { sharedServer } from './support/shared';

/** Materials that the page adds to a scene, on the real server, in all catalogue scenes. */
let observer: Observer;

beforeAll(async () => {
  observer = await Observer.join(sharedServer.url);
});
afterAll(() => observer.leave());

/** Returns the highest position for a ball of this radius; undefined if there is no space. */
function roomFor(scene: Scene, there: readonly BodyState[], radius: number): Vector | undefined {
  const { min, max } = scene.vat!;
  const shares = [0.5, 0.4, 0.6, 0.3, 0.7, 0.2, 0.8];
  const across = (axis: 0 | 1): number[] =>
    shares.map((share) => min[axis] + radius + share * (max[axis] - min[axis] - 2 * radius));
  const ys = scene.dimensions === 2 ? [0] : across(1);
  for (let z = max[2] - radius; z > min[2] + radius; z -= radius / 2) {
    for (const x of across(0)) {
      for (const y of ys) {
        const away = ([a, b, c]: Vector): number => Math.hypot(a - x, b - y, c - z);
        const isFree = there.every(({ positions }) =>
          positions.every((place) => away(place) > radius + 0.06),
        );
        if (isFree) return [x, y, z];
      }
    }
  }
  return undefined;
}

const kShipped = [
  ...['blood-vessel', 'brick-wall', 'buoyancy', 'clay', 'dam-break', 'deep-tank'],
  ...['deformable-drop', 'dew', 'hammock', 'honey', 'melting', 'pour', 'rigid-stack'],
  ...['sliding-vat-liquid', 'sliding-vat-solids', 'tearing', 'tilted-floor', 'two-liquids'],
  'water-drop',
];

it.each(kShipped)('new bodies with %s are as steady as earlier ones', async (name) => {
  for (const kind of ['liquid', 'deformable', 'rigid'] as const) {
    await observer.request('scene.load', { scene: name });
    await observer.request('control.pause', {});
    await observer.request('control.reset', {});
    const scene = (await observer.request('scene.get', { current: true })).scene;
    const offered = withNewMaterials(scene);
    const isNew = (material: string): boolean =>
      !scene.materials.some((one) => one.name === material);
    const material = materialsFor(offered, kind).find((one) => isNew(one.name));
    const size = Math.min(0.15, 0.3 * (scene.vat!.max[2] - scene.vat!.min[2]));
    const place = roomFor(scene, (await observer.request('state.query', {})).bodies, size / 2);
    if (!material || !place) continue;
    await observer.request('world.set_material', { material });
    for (const one of newInterfaces(scene, material)) {
      await observer.request('world.set_interface', { interface: one });
    }
    const choice = { kind, shape: 'sphere', material: material.name, size } as const;
    await observer.request('world.add_body', {
      body: makeBody(offered, choice, place, new Set(scene.bodies.map((body) => body.name))),
    });
    for (let tick = 5; tick <= 40; tick += 5) {
      const stepped = await observer.request('control.step', { ticks: 5 });
      expect(stepped.tick, kind).toBe(tick);
    }
    const { undone_substeps } = await observer.request('session.stats', {});
    expect(undone_substeps, kind).toBe(0);
  }
});
