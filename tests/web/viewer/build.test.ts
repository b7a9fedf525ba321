import { File as NodeFile } from 'node:buffer';
import { describe, expect, it } from 'vitest';
import type { Scene, SceneBody, SceneShape } from '../../../web/client/index';
import { massOf, volumeOf } from '../../../web/viewer/build/measures';
import {
  freeName,
  makeBody,
  materialsFor,
  spacingFor,
} from '../../../web/viewer/build/body_choice';
import { Edits } from '../../../web/viewer/build/edits';
import { readMesh } from '../../../web/viewer/build/mesh_file';
import { formatMass } from '../../../web/viewer/panel/format';
import { leanOf } from '../../../web/viewer/panel/gravity/device_tilt';

describe('volumes', () => {
  const corners = [0, 1].flatMap((x) => [0, 1].flatMap((y) => [0, 1].map((z) => [x, y, z])));
  /** A cube with two triangles per side, oriented outwards. */
  const cube: SceneShape = {
    type: 'mesh',
    vertices: corners.map(([x, y, z]) => [2 * x! + 5, y!, z!]),
    triangles: [
      [0, 1, 3],
      [0, 3, 2],
      [4, 6, 7],
      [4, 7, 5],
      [0, 4, 5],
      [0, 5, 1],
      [2, 3, 7],
      [2, 7, 6],
      [0, 2, 6],
      [0, 6, 4],
      [1, 5, 7],
      [1, 7, 3],
    ],
  };
  it.each<[SceneShape, number | undefined]>([
    [{ type: 'box', size: [1, 2, 3] }, 6],
    [{ type: 'sphere', radius: 2 }, (32 / 3) * Math.PI],
    [{ type: 'cylinder', radius: 2, height: 3 }, 12 * Math.PI],
    [cube, 2],
    [{ type: 'mesh', file: 'a.obj' }, undefined],
  ])('of %o', (shape, volume) => {
    if (volume === undefined) expect(volumeOf(shape)).toBeUndefined();
    else expect(volumeOf(shape)).toBeCloseTo(volume);
  });
});

describe('masses', () => {
  const scene = { materials: [{ name: 'oak', density: 700 }, { name: 'plain' }], bodies: [] };
  const box = { type: 'box', size: [1, 1, 2] } as const;
  const of = (body: object): number | undefined =>
    massOf(scene as unknown as Scene, { name: 'a', ...body } as SceneBody, 10);
  it.each([
    ['of a shape', { kind: 'rigid', material: 'oak', shape: box, spacing: 0.1 }, 1400],
    ['that is given', { kind: 'rigid', material: 'oak', shape: box, mass: 3 }, 3],
    [
      'of a liquid, by what is there',
      { kind: 'liquid', material: 'oak', shape: box, spacing: 0.1 },
      7,
    ],
    ['of a material without a density', { kind: 'rigid', material: 'plain', shape: box }, 2000],
    ['that nothing tells', { kind: 'liquid', material: 'oak', shape: box, mass: 5 }, undefined],
  ])('%s', (_, body, mass) => {
    if (mass === undefined) expect(of(body)).toBeUndefined();
    else expect(of(body)).toBeCloseTo(mass);
  });

  it('are written with a unit that suits', () => {
    expect([12.345, 0.5, 0.0123, 2e-6].map(formatMass)).toEqual([
      '12.3 kg',
      '500 g',
      '12.3 g',
      '2 mg',
    ]);
  });
});

it.each([
  [0, { right: 10, away: -30 }],
  [90, { right: 30, away: 10 }],
  [180, { right: -10, away: 30 }],
  [270, { right: -30, away: -10 }],
])('how a device leans, with the picture turned by %d degrees', (angle, lean) => {
  expect(leanOf(30, 10, angle)).toEqual(lean);
});

describe('Edits', () => {
  const made = (log: string[], words: string, works = true) => ({
    words,
    undo: () => Promise.resolve((log.push(`-${words}`), works)),
    redo: () => Promise.resolve((log.push(`+${words}`), works)),
  });

  it('undoes the last first, one after the other, and does again', async () => {
    const log: string[] = [];
    const edits = new Edits(() => undefined);
    edits.add(made(log, 'a'));
    edits.add(made(log, 'b'));
    void edits.undo();
    void edits.redo();
    await edits.undo();
    expect(log).toEqual(['-b', '+b', '-b']);
    expect([edits.toUndo, edits.toRedo]).toEqual(['a', 'b']);
    edits.add(made(log, 'c'));
    expect(edits.toRedo).toBeUndefined();
  });

  it('removes edits that cannot be undone any more', async () => {
    const log: string[] = [];
    const edits = new Edits(() => undefined);
    edits.add(made(log, 'a'));
    edits.add(made(log, 'b', false));
    await edits.undo();
    expect([edits.toUndo, edits.toRedo]).toEqual(['a', undefined]);
  });
});

describe('an added body', () => {
  const scene = {
    materials: [
      { name: 'water', liquid: { stiffness: 1, viscosity: 1, support_radius: 0.12 } },
      { name: 'jelly', springs: {} },
      { name: 'wood' },
    ],
    bodies: [
      { name: 'wood box', kind: 'rigid', material: 'wood', spacing: 0.04 },
      { name: 'soft', kind: 'deformable', material: 'jelly', spacing: 0.05 },
    ],
  } as unknown as Scene;

  it('is of a material that suits', () => {
    const names = (kind: 'liquid' | 'deformable' | 'rigid') =>
      materialsFor(scene, kind).map(({ name }) => name);
    expect([names('liquid'), names('deformable'), names('rigid')]).toEqual([
      ['water'],
      ['jelly'],
      ['wood'],
    ]);
  });

  it('has the spacing of similar bodies, or a spacing for its liquid', () => {
    expect(spacingFor(scene, 'rigid', 'wood')).toBe(0.04);
    expect(spacingFor(scene, 'deformable', 'another')).toBe(0.05);
    expect(spacingFor(scene, 'liquid', 'water')).toBeCloseTo(0.06);
    expect(spacingFor({ ...scene, bodies: [] }, 'rigid', 'wood')).toBe(0.05);
  });

  it('has a name of its own', () => {
    expect(freeName('a', new Set())).toBe('a');
    expect(freeName('a', new Set(['a', 'a 2']))).toBe('a 3');
    const choice = { kind: 'rigid', shape: 'box', material: 'wood', size: 0.3 } as const;
    expect(makeBody(scene, choice, [1, 2, 3], new Set(['wood box']))).toEqual({
      name: 'wood box 2',
      kind: 'rigid',
      material: 'wood',
      spacing: 0.04,
      shape: { type: 'box', size: [0.3, 0.3, 0.3] },
      position: [1, 2, 3],
    });
  });
});

/** Node 18 has no global File. */
const fileOf = (name: string, content: string | DataView): File =>
  new NodeFile([content], name) as unknown as File;

describe('meshes from files', () => {
  const tetrahedron = [
    'v 0 0 0\nv 2 0 0\nv 0 4 0\nv 0 0 2',
    'f 1/1 3/2 2/3\nf 1 2 4\nf -4 -1 -2\nf 2 3 4',
  ].join('\n');

  it('of an .obj file are put about the origin, with a longest side of 1', async () => {
    const mesh = await readMesh(fileOf('a.obj', tetrahedron));
    if ('fault' in mesh) throw new Error(mesh.fault);
    expect(mesh.vertices[0]).toEqual([-0.25, -0.5, -0.25]);
    expect(mesh.vertices[1]).toEqual([-0.25, 0.5, -0.25]); // numbered in the order of the faces
    expect(mesh.triangles).toEqual([
      [0, 1, 2],
      [0, 2, 3],
      [0, 3, 1],
      [2, 1, 3],
    ]);
    expect(mesh.volume).toBeCloseTo((2 * 4 * 2) / 6 / 64);
  });

  async function trianglesOf(name: string, content: string | DataView): Promise<unknown> {
    const mesh = await readMesh(fileOf(name, content));
    return 'fault' in mesh ? mesh.fault : mesh.triangles;
  }

  it('split faces of more than three corners', async () => {
    expect(await trianglesOf('a.obj', 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4')).toEqual([
      [0, 1, 2],
      [0, 2, 3],
    ]);
  });

  it('of an .stl file, text or binary, share their corners', async () => {
    const places = [
      [0, 0, 0],
      [1, 0, 0],
      [0, 1, 0],
      [1, 0, 0],
      [1, 1, 0],
      [0, 1, 0],
    ];
    const facet = (corners: number[][]): string =>
      `facet normal 0 0 1\nouter loop\n${corners
        .map((place) => `vertex ${place.join(' ')}`)
        .join('\n')}\nendloop\nendfacet`;
    const text = `solid\n${facet(places.slice(0, 3))}\n${facet(places.slice(3))}\nendsolid`;
    const binary = new DataView(new ArrayBuffer(84 + 100));
    binary.setUint32(80, 2, true);
    places.forEach((place, n) =>
      place.forEach((x, axis) =>
        binary.setFloat32(84 + Math.floor(n / 3) * 50 + 12 + (n % 3) * 12 + axis * 4, x, true),
      ),
    );
    for (const content of [text, binary]) {
      expect(await trianglesOf('a.STL', content)).toEqual([
        [0, 1, 2],
        [1, 3, 2],
      ]);
    }
  });

  it.each([
    ['a.obj', 'hello', 'no triangles'],
    ['a.obj', 'v 0 0 0\nf 1 2 3', 'no triangles'],
    ['a.stl', 'solid vertex 1 2', 'no triangles'],
    ['a.stl', '', 'no triangles'],
    ['a.obj', 'v 1 1 1\nf 1 1 1', 'a single point'],
    ['a.obj', `v 0 0 0\nv 1 0 0\nv 0 1 0\n${'f 1 2 3\n'.repeat(30_000)}`, 'too many triangles'],
  ])('are rejected if they are empty or too large: %s, %#', async (name, text, words) => {
    const read = await readMesh(fileOf(name, text));
    expect('fault' in read && read.fault).toContain(words);
  });
});
