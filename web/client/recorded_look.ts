import type { Appearance, MaterialDescription, SceneShape, Vector } from './messages.js';
import { bad, choiceOf, listOf, numberOf, objectOf, textOf, vectorOf } from './recording/values.js';

const kMostVertices = 600_000;
const kMostTriangles = 200_000;
const kLeastLength = 1e-9;
const kMostLength = 1e9;

export function materialOf(value: unknown): MaterialDescription {
  const members = objectOf(value, 'a material');
  const material: MaterialDescription = {
    name: textOf(members.name, 'name'),
    appearance: appearanceOf(members.appearance),
  };
  const strain = members.tearing_strain;
  if (strain !== undefined) material.tearing_strain = numberOf(strain, 'tearing_strain', 0, 1e9);
  return material;
}

function appearanceOf(value: unknown): Appearance {
  const members = objectOf(value, 'appearance');
  const appearance: Appearance = {};
  const { colour, finish, absorption_length: length } = members;
  if (colour !== undefined) {
    appearance.colour = textOf(colour, 'colour');
    if (!/^#[0-9a-f]{6}$/i.test(appearance.colour)) throw bad('colour', '# and six digits');
  }
  for (const name of ['roughness', 'metalness', 'opacity'] as const) {
    if (members[name] !== undefined) appearance[name] = numberOf(members[name], name, 0, 1);
  }
  if (length !== undefined) appearance.absorption_length = lengthOf(length, 'absorption_length');
  if (finish !== undefined) {
    const all = ['none', 'wood', 'brick', 'rubber', 'steel', 'clay'] as const;
    appearance.finish = choiceOf(finish, 'finish', all);
  }
  return appearance;
}

export function lengthOf(value: unknown, name: string): number {
  return numberOf(value, name, kLeastLength, kMostLength);
}

/** Returns the shape of a solid. */
export function shapeOf(value: unknown): SceneShape {
  const members = objectOf(value, 'shape');
  const type = choiceOf(members.type, 'type', ['box', 'sphere', 'cylinder', 'mesh'] as const);
  if (type === 'mesh') return meshOf(members);
  const center = members.center === undefined ? {} : { center: vectorOf(members.center, 'center') };
  switch (type) {
    case 'box': {
      const size = vectorOf(members.size, 'size');
      for (const side of size) lengthOf(side, 'size');
      return { type, size, ...center };
    }
    case 'sphere':
      return { type, radius: lengthOf(members.radius, 'radius'), ...center };
    case 'cylinder':
      return {
        type,
        radius: lengthOf(members.radius, 'radius'),
        height: lengthOf(members.height, 'height'),
        ...(members.axis !== undefined && { axis: vectorOf(members.axis, 'axis') }),
        ...center,
      };
  }
}

function meshOf(members: Record<string, unknown>): SceneShape {
  const vertices = listOf(members.vertices, 'vertices', kMostVertices).map((one) =>
    vectorOf(one, 'vertices'),
  );
  const triangles = listOf(members.triangles, 'triangles', kMostTriangles).map((one) => {
    const corners: Vector = vectorOf(one, 'triangles');
    const areVertices = corners.every((k) => Number.isInteger(k) && k >= 0 && k < vertices.length);
    if (!areVertices) throw bad('triangles', 'numbers of vertices');
    return corners;
  });
  return { type: 'mesh', vertices, triangles };
}
