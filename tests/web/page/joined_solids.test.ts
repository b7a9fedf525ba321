import { Color, Matrix4, Mesh } from 'three';
import type { BufferAttribute, DataTexture, ShaderMaterial, Vector4 } from 'three';
import { beforeEach, describe, expect, it } from 'vitest';
import type { BodyDescription } from '../../../web/client/index';
import { kLayers } from '../../../web/viewer/view/base/layers';
import { sharedUniforms } from '../../../web/viewer/view/bodies/shared_uniforms';
import { BodyTable } from '../../../web/viewer/view/particles/body_table';
import { bodyUniforms, kSquareVertices } from '../../../web/viewer/view/particles/impostor';
import { JoinedParticles } from '../../../web/viewer/view/particles/joined_particles';
import { JoinedSolids } from '../../../web/viewer/view/solids/joined_solids';
import type { Joinable } from '../../../web/viewer/view/solids/solid';
import { solidOf } from '../../../web/viewer/view/solids/solid_of';

const shared = sharedUniforms();
let joined: JoinedSolids;
beforeEach(() => (joined = new JoinedSolids(shared)));

/** A rigid box of this width, with a row of the table. */
function boxOf(row: number, width: number, finish = 0): Joinable {
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
  return { row, solid };
}

const meshes = (): Mesh[] => joined.group.children as Mesh[];
const isAlone = ({ solid }: Joinable): boolean => solid.mesh.layers.isEnabled(kLayers.scene);
describe('JoinedSolids', () => {
  it('draws bodies of one finish by one mesh, and a single one by its own', () => {
    const bodies = [boxOf(0, 2), boxOf(1, 3), boxOf(2, 4, 1), boxOf(3, 5, 1), boxOf(4, 6, 2)];
    joined.update(bodies);
    expect(meshes()).toHaveLength(2);
    const finishes = meshes().map(({ material }) => (material as ShaderMaterial).defines.FINISH);
    expect(finishes).toEqual([0, 1]);
    expect(bodies.map(isAlone)).toEqual([false, false, false, false, true]);
    for (const { layers } of meshes()) expect(layers.isEnabled(kLayers.casters)).toBe(true);
  });

  it('has the vertices of each body, with its row of the table', () => {
    const bodies = [boxOf(3, 2), boxOf(7, 3)];
    joined.update(bodies);
    const [mesh] = meshes();
    const rows = mesh!.geometry.getAttribute('row') as BufferAttribute;
    const positions = mesh!.geometry.getAttribute('position');
    const widest = new Map<number, number>();
    for (let i = 0; i < rows.count; ++i) {
      const row = rows.getX(i);
      widest.set(row, Math.max(widest.get(row) ?? 0, Math.round(100 * positions.getX(i)) / 100));
    }
    expect([...widest]).toEqual([
      [4, 1],
      [8, 1.5],
    ]);
    const counts = bodies.map(({ solid }) => solid.mesh.geometry.getAttribute('position').count);
    expect(rows.count).toBe(counts[0]! + counts[1]!);
    const corners = Math.max(...mesh!.geometry.getIndex()!.array);
    expect(corners).toBe(rows.count - 1);
  });

  it('returns bodies to their own meshes', () => {
    const bodies = [boxOf(0, 2), boxOf(1, 3), boxOf(2, 4)];
    joined.update(bodies);
    joined.update(bodies.slice(0, 1));
    expect(meshes()).toEqual([]);
    expect(bodies.map(isAlone)).toEqual([true, true, true]);
  });
});

describe('BodyTable', () => {
  it('has the values of each body, also after it has grown', () => {
    const table = new BodyTable(shared.look);
    const uniforms = bodyUniforms(new Color(0.25, 0.5, 0.75), shared.look, false);
    uniforms.roughness.value = 0.125;
    table.reserve(1);
    table.reserve(3);
    const pose = new Matrix4().makeTranslation(7, 8, 9);
    table.write(1, pose, uniforms, { length: 3, radius: 0.5 });
    table.finish();
    const texture = shared.look.body_table.value!;
    expect([texture.image.width, texture.image.height]).toEqual([7, 3]);
    const row = (texture.image.data as Float32Array).slice(28, 56);
    expect([...row.slice(0, 4)]).toEqual([1, 0, 0, 0.125]);
    expect([...row.slice(12, 15)]).toEqual([0.25, 0.5, 0.75]);
    expect([...row.slice(16, 20)]).toEqual([7, 8, 9, 3]);
    expect(row[23]).toBe(0.5);
  });
});

describe('JoinedParticles', () => {
  const bodyOf = (row: number, places: number[]) => ({
    row,
    places,
    spheres: new Mesh(),
    spots: new Mesh(),
  });

  it('draws the visible particles of several bodies by one mesh of each kind', () => {
    const particles = new JoinedParticles(shared);
    const [spots, spheres] = particles.group.children as Mesh[];
    const bodies = [bodyOf(0, [0, 0, 0, 1, 0, 0]), bodyOf(2, [0, 0, 5])];
    for (const body of bodies) body.spots.visible = false;
    particles.update(bodies);
    expect([spots!.visible, spheres!.visible]).toEqual([false, true]);
    const { uniforms } = spheres!.material as ShaderMaterial;
    const texels = (name: string, count: number): number[] => [
      ...((uniforms[name]!.value as DataTexture).image.data as Uint16Array).subarray(0, count),
    ];
    expect(spheres!.geometry.drawRange.count).toBe(3 * kSquareVertices);
    const { x, w } = uniforms.texel_grid!.value as Vector4;
    const places = texels('center_texels', 9).map((at) => x + w * at);
    [0, 0, 0, 1, 0, 0, 0, 0, 5].forEach((at, i) => expect(places[i]).toBeCloseTo(at, 3));
    expect(texels('before_texels', 9)).toEqual(texels('center_texels', 9));
    expect(texels('name_texels', 6)).toEqual([0, 1, 1, 1, 0, 3]); // number, row
    const drawn = (): boolean[] => bodies.map((one) => one.spheres.layers.isEnabled(kLayers.scene));
    expect(drawn()).toEqual([false, false]);
    particles.update(bodies.slice(0, 1));
    expect(spheres!.visible).toBe(false);
    expect(drawn()).toEqual([true, true]);
  });
});
