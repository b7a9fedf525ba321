import { formatCount, formatMass } from '../panel/format';
import { densityOf, massOf } from './measures';
import type { SceneDocument } from './scene_document';

/** Returns the inspector's rows about a body; empty if the server does not supply the scene. */
export async function matterOf(
  document: SceneDocument,
  name: string,
  particles: number,
): Promise<[string, string][]> {
  const scene = await document.get();
  const body = scene?.bodies.find((candidate) => candidate.name === name);
  if (!scene || !body) return [];
  const mass = massOf(scene, body, particles);
  return [
    ['Density', `${formatCount(densityOf(scene, body.material))} kg/m³`],
    ...(mass === undefined ? [] : [['Mass', formatMass(mass)] as [string, string]]),
  ];
}
