import type { Scene, SceneBody, SceneShape, Vector } from '../../client/index';

/** The default in SCENE.md [kg/m³]. */
const kDensity = 1000;

/** Returns the volume of a shape [m³]; undefined if the scene does not define it. */
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

/** Returns the volume by the divergence theorem: the sum of signed tetrahedra from the origin. */
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

/** Returns the density of a material [kg/m³]. */
export function densityOf({ materials }: Pick<Scene, 'materials'>, material: string): number {
  return materials.find(({ name }) => name === material)?.density ?? kDensity;
}

/** Returns the mass of a body with this number of particles [kg]; undefined if it is unknown. */
export function massOf(scene: Scene, body: SceneBody, particles: number): number | undefined {
  const { shape, spacing, mass, kind } = body;
  if (shape.type === 'particles' && shape.masses) return shape.masses.reduce((a, b) => a + b, 0);
  if (kind !== 'liquid' && mass !== undefined) return mass;
  if (mass !== undefined) return undefined; // the number of particles can have changed
  const density = densityOf(scene, body.material);
  const perParticle = spacing === undefined ? undefined : density * spacing ** 3;
  if (kind === 'liquid' || shape.type === 'particles') {
    return perParticle === undefined ? undefined : perParticle * particles;
  }
  const volume = volumeOf(shape);
  return volume === undefined ? undefined : density * volume;
}
