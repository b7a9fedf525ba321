import { Color, Mesh } from 'three';
import type { DataTexture, ShaderMaterial } from 'three';
import { beforeEach, describe, expect, it } from 'vitest';
import { BodyKind } from '../../../web/client/index';
import { kLayers } from '../../../web/viewer/view/base/layers';
import { sharedUniforms } from '../../../web/viewer/view/bodies/shared_uniforms';
import { LiquidDrawing } from '../../../web/viewer/view/fluid/liquid_drawing';
import { bodyUniforms, kSquareVertices } from '../../../web/viewer/view/particles/impostor';
import { JoinedColumns } from '../../../web/viewer/view/particles/joined_columns';
import { JoinedGrids } from '../../../web/viewer/view/particles/joined_grids';
import type { GridParticles } from '../../../web/viewer/view/particles/joined_grids';
import { ParticleColumns } from '../../../web/viewer/view/particles/particle_columns';
import { sphereMaterial } from '../../../web/viewer/view/particles/sphere_material';
import type { Texels } from '../../../web/viewer/view/particles/texels';

const kGrid = { origin: [0, 0, 0] as [number, number, number], quantum: 1 };
const shared = sharedUniforms();

function show(columns: ParticleColumns, x: number[], numbers?: number[]): void {
  const positions = Uint16Array.from(x.flatMap((at) => [at, 0, 0]));
  const kind: typeof BodyKind.liquid = BodyKind.liquid;
  const named = numbers && Uint32Array.from(numbers);
  columns.show({ kind, body: 1, positions, numbers: named, attributes: [] }, kGrid);
}

function bodyOf(body: number, x: number[]): GridParticles {
  const columns = new ParticleColumns(x.length);
  show(columns, x);
  const uniforms = { ...bodyUniforms(new Color(), shared.look, true), ...columns.uniforms };
  const mesh = (): Mesh => new Mesh(columns.geometry, sphereMaterial(uniforms, 1));
  return { body, row: body + 10, columns, spheres: mesh(), spots: mesh(), valueQuantum: 1 };
}

type Numbers = ArrayLike<number>;

/** Returns the first of `size` numbers of each shown particle. */
function firsts({ values }: { values: Numbers }, size: number): number[] {
  const count = joined.geometry.drawRange.count / kSquareVertices;
  return Array.from({ length: count }, (_, i) => values[size * i]!);
}

let joined: JoinedColumns;
beforeEach(() => (joined = new JoinedColumns()));

describe('JoinedColumns', () => {
  it('has the particles of all bodies, with the rows of the table', () => {
    const bodies = [bodyOf(1, [10, 20]), bodyOf(2, [30])];
    show(bodies[0]!.columns, [14, 24]);
    joined.update(bodies);
    expect(firsts(joined.columns.center, 3)).toEqual([14, 24, 30]);
    expect(firsts(joined.columns.before, 3)).toEqual([10, 20, 30]);
    const { values } = joined.columns.names;
    expect([1, 3, 5].map((i) => values[i])).toEqual([12, 12, 13]); // rows
    expect(firsts(joined.columns.names, 2)).toEqual([0, 1, 0]);
  });

  it('follows growing and shrinking bodies', () => {
    const body = bodyOf(1, [10]);
    for (const x of [[1, 2, 3, 4, 5, 6, 7], [8], [], [1, 2]]) {
      show(body.columns, x, x);
      joined.update([body]);
      expect(firsts(joined.columns.center, 3)).toEqual(x);
      expect(firsts(joined.columns.names, 2)).toEqual(x);
    }
  });

  it('releases buffers that are too small', () => {
    let releases = 0;
    const many = (count: number): number[] => Array.from({ length: count }, (_, i) => i);
    const body = bodyOf(1, [10]);
    joined.update([body]);
    for (const { texture } of Object.values(joined.columns) as Texels<Uint8Array>[]) {
      texture.addEventListener('dispose', () => ++releases);
    }
    show(body.columns, many(150));
    joined.update([body]);
    expect(releases).toBe(0);
    expect(firsts(joined.columns.names, 2)).toEqual(many(150));
    show(body.columns, many(5000));
    joined.update([body]);
    expect(releases).toBe(6);
    expect(firsts(joined.columns.center, 3)).toEqual(many(5000));
  });

  it('copies columns after changes only', () => {
    const bodies = [bodyOf(1, [10]), bodyOf(2, [30])];
    expect(joined.update(bodies)).toBe(true);
    expect(joined.update(bodies)).toBe(false);
    bodies[1]!.columns.showValues(Int32Array.of(7));
    expect(joined.update(bodies)).toBe(true);
    expect(firsts(joined.columns.shown, 1)).toEqual([0, 7]);
    expect(joined.update(bodies.slice(0, 1))).toBe(true);
    expect(joined.geometry.drawRange.count).toBe(kSquareVertices);
  });
});

describe('JoinedGrids', () => {
  it('draws the visible particles of several bodies by one mesh, and of one by its own', () => {
    const grids = new JoinedGrids(shared);
    const bodies = [bodyOf(1, [10]), bodyOf(2, [30, 40]), bodyOf(3, [50])];
    const isAlone = (): boolean[] =>
      bodies.map(({ spheres }) => spheres.layers.isEnabled(kLayers.scene));
    const joinedCounts = (): number[] =>
      (grids.group.children as Mesh[])
        .filter(({ visible }) => visible)
        .map(({ geometry }) => geometry.drawRange.count / kSquareVertices);
    bodies[2]!.spheres.visible = false;
    grids.update(bodies);
    expect(joinedCounts()).toEqual([4, 3]); // spots, spheres
    expect(isAlone()).toEqual([false, false, true]);
    bodies[1]!.spheres.visible = bodies[1]!.spots.visible = false;
    grids.update(bodies);
    expect(joinedCounts()).toEqual([2]);
    expect(isAlone()).toEqual([true, true, true]);
  });
});

describe('LiquidDrawing', () => {
  it.each([
    ['fluid', 3],
    ['splats', 2],
    ['particles', 0],
    ['surface', 0],
  ] as const)('draws all liquids as %s by %i meshes', (style, count) => {
    const drawing = new LiquidDrawing(shared);
    const time = { ...kGrid, seconds: 0.02, height: 1 };
    const liquids = [1, 2, 3].map((body) => ({ ...bodyOf(body, [10 * body]), radius: 1 }));
    drawing.style = style;
    drawing.update(liquids, () => [], time);
    const { visible, children } = drawing.group;
    expect(visible ? children.filter((mesh) => mesh.visible).length : 0).toBe(count);
    drawing.update([], () => [], time);
    expect(drawing.group.visible).toBe(false);
  });

  it('marks isolated particles also if the style changes while no frame comes', () => {
    const drawing = new LiquidDrawing(shared);
    const body = bodyOf(1, [1, 2, 3, 1000]);
    const update = (): void => {
      const { row, columns } = body;
      const liquid = { body: 1, row, columns, valueQuantum: 1, radius: 1 };
      drawing.update([liquid], () => [], { ...kGrid, seconds: 0.02, height: 1 });
    };
    const { uniforms } = (drawing.group.children[0] as Mesh).material as ShaderMaterial;
    const texels = (): DataTexture => uniforms.froth_texels!.value as DataTexture;
    const lone = (particle: number): number =>
      (texels().image.data as Uint8Array)[2 * particle + 1]!;
    update();
    expect(lone(3)).toBe(0);
    const { version } = texels();
    drawing.style = 'fluid';
    update();
    expect(lone(3)).toBeGreaterThan(127);
    expect(lone(1)).toBeLessThan(lone(3));
    expect(texels().version).toBe(version + 1); // uploaded once
    update();
    expect(texels().version).toBe(version + 1);
  });
});
