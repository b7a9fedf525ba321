import { Box3, Vector3 } from 'three';
import { expect, it } from 'vitest';
import { kLayers } from '../../../web/viewer/view/base/layers';
import { kSunWay } from '../../../web/viewer/view/base/light';
import { sharedUniforms } from '../../../web/viewer/view/bodies/shared_uniforms';
import { solidOf } from '../../../web/viewer/view/solids/solid_of';
import { SunShadow } from '../../../web/viewer/view/shadow/sun_shadow';
import { bodyUniforms } from '../../../web/viewer/view/particles/impostor';
import { lookOf } from '../../../web/viewer/view/base/appearance';

const kBox = new Box3(new Vector3(1, 2, 0), new Vector3(3, 2.5, 1));

it('covers the scene and the space above it, the nearest to the sun first', () => {
  const { sun, look } = sharedUniforms();
  const shadow = new SunShadow(sun, look, false);
  expect(sun.sun_texel.value).toBe(0); // no shadows before the scene is known
  shadow.fit(kBox);
  const inMap = (point: Vector3): Vector3 => point.clone().applyMatrix4(sun.to_sun.value);
  for (const x of [1, 3]) {
    for (const y of [2, 2.5]) {
      for (const z of [0, 1.5]) {
        const at = inMap(new Vector3(x, y, z)).toArray();
        for (const coordinate of at) {
          expect(coordinate).toBeGreaterThanOrEqual(0);
          expect(coordinate).toBeLessThanOrEqual(1);
        }
      }
    }
  }
  const floor = new Vector3(2, 2.2, 0);
  const above = floor.clone().addScaledVector(new Vector3(...kSunWay), 0.5);
  expect(inMap(above).x).toBeCloseTo(inMap(floor).x, 6);
  expect(inMap(above).y).toBeCloseTo(inMap(floor).y, 6);
  expect(inMap(above).z).toBeLessThan(inMap(floor).z);
  expect(new Vector3(...kSunWay).length()).toBeCloseTo(1, 2);
});

it('is cast by the surfaces of solids, which stay in the scene', () => {
  const shared = sharedUniforms();
  const description = {
    body: 1,
    name: 'crate',
    kind: 'rigid' as const,
    material: 'wood',
    particles: 1,
    radius: 1,
    shape: { type: 'box' as const, size: [1, 1, 1] as [number, number, number] },
  };
  const uniforms = bodyUniforms(lookOf(undefined).colour, shared.look, false);
  const solid = solidOf(description, uniforms, shared)!;
  expect(solid.mesh.layers.isEnabled(kLayers.casters)).toBe(true);
  expect(solid.mesh.layers.isEnabled(kLayers.scene)).toBe(true);
  expect(solid.mesh.material.uniforms.sun_map).toBe(shared.sun.sun_map);
});
