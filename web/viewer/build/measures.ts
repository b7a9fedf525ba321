import type { Scene, SceneBody, SceneShape, Vector } from '../../client/index';

/** SCENE.md's default. */
const kDensity = 1000;

/** Of a shape that is filled [m³]; undefined where the scene does not tell it. */
export function volumeOf(shape: SceneShape): number | undefined {
  switch (shape.type) {
    case 'box':
      return shape.size[0] * shape.size[1] * shape.size[2];
    case 'sphere':
      return (4 / 3) * Math.PI * shape.radius ** 3;
    case 'cylinder':
      return Math.PI * shape.radius ** 2 * shape.height;
    case 'mesh':
      return 'vertices' in shape ? meshVolume(shape.vertices, shape.triangles) : undefined;
    case 'particles':
      return undefined;
  }
}

/** By the divergence theorem: tetrahedra from the origin to each triangle, with their signs. */
export function meshVolume(vertices: readonly Vector[], triangles: readonly Vector[]): number {
  let sum = 0;
  for (const corners of triangles) {
    const [a, b, c] = corners.map((n) => vertices[n]) as [Vector, Vector, Vector];
    sum +=
      a[0] * (b[1] * c[2] - b[2] * c[1]) +
      a[1] * (b[2] * c[0] - b[0] * c[2]) +
      a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return Math.abs(sum) / 6;
}

/** Of the material of a body [kg/m³]. */
export function densityOf({ materials }: Scene, material: string): number {
  return materials.find(({ name }) => name === material)?.density ?? kDensity;
}

/** Of a body with so many particles now [kg], as SCENE.md says; undefined where it does not tell. */
export function massOf(scene: Scene, body: SceneBody, particles: number): number | undefined {
  const { shape, spacing, mass, kind } = body;
  if (shape.type === 'particles' && shape.masses) return shape.masses.reduce((a, b) => a + b, 0);
  if (kind !== 'liquid' && mass !== undefined) return mass;
  if (mass !== undefined) return undefined; // some of it may have gone or come
  const density = densityOf(scene, body.material);
  const perParticle = spacing === undefined ? undefined : density * spacing ** 3;
  if (kind === 'liquid' || shape.type === 'particles') {
    return perParticle === undefined ? undefined : perParticle * particles;
  }
  const volume = volumeOf(shape);
  return volume === undefined ? undefined : density * volume;
}
