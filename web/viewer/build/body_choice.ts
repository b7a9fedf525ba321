import type { BodyKindName, Scene, SceneBody, SceneMaterial, Vector } from '../../client/index';
import type { MeshShape } from './mesh_file';

/** The user's choice of a new body. */
export interface BodyChoice {
  kind: BodyKindName;
  shape: 'sphere' | 'box' | 'mesh';
  material: string;
  /** The longest side [m]. */
  size: number;
  /** The mesh, if the shape is a mesh. Its longest side is 1. */
  mesh?: MeshShape;
}

/** The default spacing [m]. */
export const kSpacing = 0.05;

/** The support radius of liquids divided by the spacing, as in the catalogue. */
const kSupportInSpacings = 2;

/** Returns the materials for bodies of this kind. */
export function materialsFor({ materials }: Scene, kind: BodyKindName): SceneMaterial[] {
  switch (kind) {
    case 'liquid':
      return materials.filter(({ liquid }) => liquid !== undefined);
    case 'deformable':
      return materials.filter(({ springs }) => springs !== undefined);
    case 'rigid':
      return materials.filter(({ liquid, springs }) => !liquid && !springs);
  }
}

/** Returns the spacing [m] of the scene's bodies of this material, of this kind, or of any body. */
export function spacingFor(scene: Scene, kind: BodyKindName, material: string): number {
  const filled = scene.bodies.filter(({ spacing }) => spacing !== undefined);
  const alike = filled.find((body) => body.kind === kind && body.material === material);
  if (alike) return alike.spacing!;
  const liquid = scene.materials.find(({ name }) => name === material)?.liquid;
  if (kind === 'liquid' && liquid) return liquid.support_radius / kSupportInSpacings;
  return filled.find((body) => body.kind === kind)?.spacing ?? filled[0]?.spacing ?? kSpacing;
}

/** Returns the approximate number of particles. */
export function particlesOf(scene: Scene, choice: BodyChoice): number {
  const { kind, shape, material, size } = choice;
  const { dimensions = 3 } = scene;
  const ball = dimensions === 2 ? Math.PI / 4 : Math.PI / 6;
  const share = shape === 'sphere' ? ball : shape === 'box' ? 1 : (choice.mesh?.volume ?? 0);
  const across = size / spacingFor(scene, kind, material);
  return Math.max(Math.round(share * across ** dimensions), 1);
}

/** Returns the body in the format of the protocol. `taken` are the names in use. */
export function makeBody(
  scene: Scene,
  choice: BodyChoice,
  position: Vector,
  taken: ReadonlySet<string>,
): SceneBody {
  const { kind, material } = choice;
  return {
    name: freeName(`${material} ${choice.shape === 'sphere' ? 'ball' : choice.shape}`, taken),
    kind,
    material,
    spacing: spacingFor(scene, kind, material),
    shape: shapeOf(choice),
    position: inWorld(scene, position),
  };
}

/** Projects a vector to the plane y = 0 if the scene is two-dimensional. */
export function inWorld({ dimensions }: Scene, [x, y, z]: Vector): Vector {
  return [x, dimensions === 2 ? 0 : y, z];
}

function shapeOf({ shape, size, mesh }: BodyChoice): SceneBody['shape'] {
  if (shape === 'sphere') return { type: 'sphere', radius: size / 2 };
  if (shape === 'box' || !mesh) return { type: 'box', size: [size, size, size] };
  const vertices = mesh.vertices.map((place) => place.map((x) => x * size) as Vector);
  return { type: 'mesh', vertices, triangles: mesh.triangles, source: mesh.name };
}

/** Returns the name, with the first free number if it is taken. */
export function freeName(name: string, taken: ReadonlySet<string>): string {
  if (!taken.has(name)) return name;
  let number = 2;
  while (taken.has(`${name} ${number}`)) number += 1;
  return `${name} ${number}`;
}
