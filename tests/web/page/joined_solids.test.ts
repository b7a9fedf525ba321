import { Color, DataTexture, Matrix4 } from 'three';
import type { BufferAttribute, Mesh, ShaderMaterial } from 'three';
import { beforeEach, describe, expect, it } from 'vitest';
import type { BodyDescription } from '../../../web/client/index';
import { kLayers } from '../../../web/viewer/view/base/layers';
import { sharedUniforms } from '../../../web/viewer/view/bodies/shared_uniforms';
import { bodyUniforms } from '../../../web/viewer/view/particles/impostor';
import { JoinedSolids } from '../../../web/viewer/view/solids/joined_solids';
import type { Joinable } from '../../../web/viewer/view/solids/solid';
import { solidOf } from '../../../web/viewer/view/solids/solid_of';

const shared = sharedUniforms();
let joined: JoinedSolids;
beforeEach(() => (joined = new JoinedSolids(shared)));

/** A rigid box of this width at x = 10 width. */
function boxOf(width: number, finish = 0): Joinable {
  const description: BodyDescription = {
    body: width,
    name: 'box',
    kind: 'rigid',
    material: 'wood',
    radius: 0.1,
    particles: 1,
    local_positions: [0, 0, 0],
    shape: { type: 'box', size: [width, 1, 1] },
  };
  const uniforms = bodyUniforms(new Color(0.1 * width, 0, 0), shared.look, false);
  const solid = solidOf(description, uniforms, shared)!;
  solid.finish = finish;
  solid.mesh.visible = true;
  return { solid, uniforms, matrix: new Matrix4().makeTranslation(10 * width, 0, 0) };
}

const meshes = (): Mesh[] => joined.group.children as Mesh[];
const isAlone = ({ solid }: Joinable): boolean => solid.mesh.layers.isEnabled(kLayers.scene);
const tableOf = (): Float32Array =>
  (shared.table.body_table.value as DataTexture).image.data as Float32Array;

describe('JoinedSolids', () => {
  it('draws bodies of one finish by one mesh, and a single one by its own', () => {
    const bodies = [boxOf(2), boxOf(3), boxOf(4, 1), boxOf(5, 1), boxOf(6, 2)];
    joined.update(bodies);
    expect(meshes()).toHaveLength(2);
    const finishes = meshes().map(({ material }) => (material as ShaderMaterial).defines.FINISH);
    expect(finishes).toEqual([0, 1]);
    expect(bodies.map(isAlone)).toEqual([false, false, false, false, true]);
    for (const { layers } of meshes()) expect(layers.isEnabled(kLayers.casters)).toBe(true);
  });

  it('has the vertices of each body, with its row of the table', () => {
    const bodies = [boxOf(2), boxOf(3)];
    joined.update(bodies);
    const [mesh] = meshes();
    const rows = mesh!.geometry.getAttribute('row') as BufferAttribute;
    const positions = mesh!.geometry.getAttribute('position');
    const widest = [0, 0];
    for (let i = 0; i < rows.count; ++i) {
      const row = rows.getX(i) - 1;
      widest[row] = Math.max(widest[row]!, positions.getX(i));
    }
    expect(widest.map((x) => Math.round(100 * x) / 100)).toEqual([1, 1.5]);
    const counts = bodies.map(({ solid }) => solid.mesh.geometry.getAttribute('position').count);
    expect(rows.count).toBe(counts[0]! + counts[1]!);
    const corners = Math.max(...mesh!.geometry.getIndex()!.array);
    expect(corners).toBe(rows.count - 1);
  });

  it('writes pose, colour and length of each picture', () => {
    const bodies = [boxOf(2), boxOf(3)];
    joined.update(bodies);
    const before = meshes()[0];
    bodies[1]!.matrix.makeTranslation(7, 8, 9);
    bodies[1]!.uniforms.colour.value.setRGB(0.25, 0.5, 0.75);
    joined.update(bodies);
    expect(meshes()[0]).toBe(before);
    const [first, second] = [tableOf().slice(0, 28), tableOf().slice(28)];
    expect([...first.slice(16, 20)]).toEqual([20, 0, 0, 2]);
    expect([...second.slice(12, 15)]).toEqual([0.25, 0.5, 0.75]);
    expect([...second.slice(16, 20)]).toEqual([7, 8, 9, 3]);
  });

  it('returns bodies to their own meshes', () => {
    const bodies = [boxOf(2), boxOf(3), boxOf(4)];
    joined.update(bodies);
    joined.update(bodies.slice(0, 1));
    expect(meshes()).toEqual([]);
    expect(bodies.map(isAlone)).toEqual([true, true, true]);
  });
});
