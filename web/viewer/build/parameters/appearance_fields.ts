import type { Appearance, SceneMaterial } from '../../../client/index';
import type { ValueSpec } from './value_field';

export type AppearanceName = keyof Appearance;

type NumberName = 'roughness' | 'metalness' | 'opacity' | 'absorption_length';

export type AppearanceField = ValueSpec & { name: NumberName };

const field = (
  name: NumberName,
  label: string,
  unit: string,
  [min, max]: readonly [number, number],
): AppearanceField => ({
  id: `appearance-${name}`,
  name,
  label,
  unit,
  min,
  max,
  otherwise: 'auto',
});

/** The numbers of an appearance, with the ranges in SCENE.md. */
export const kAppearanceFields: readonly AppearanceField[] = [
  field('roughness', 'Roughness', '0 mirror, 1 matt', [0, 1]),
  field('metalness', 'Metalness', '0 dielectric, 1 metal', [0, 1]),
  field('opacity', 'Opacity', '0 transparent, 1 opaque', [0, 1]),
];

/** Only for liquids. */
export const kAbsorptionField = field(
  'absorption_length',
  'Absorption length',
  'm, depth with full colour',
  [1e-6, 1e6],
);

export const kFinishes: Readonly<Record<NonNullable<Appearance['finish']>, string>> = {
  none: 'plain',
  wood: 'wood',
  brick: 'brick',
  rubber: 'rubber',
  steel: 'brushed steel',
  clay: 'clay',
};

/** Returns the material with another value of a member, or without it: it then follows the name. */
export function withAppearance<N extends AppearanceName>(
  material: SceneMaterial,
  name: N,
  value: Appearance[N] | undefined,
): SceneMaterial {
  const { appearance: before = {}, ...others } = material;
  const entries = Object.entries(before).filter(([key]) => key !== name);
  if (value !== undefined) entries.push([name, value]);
  if (entries.length === 0) return others;
  return { ...others, appearance: Object.fromEntries(entries) as Appearance };
}

/** Returns the material with the appearance of another one, or without it. */
export function withAppearanceOf(
  material: SceneMaterial,
  other: SceneMaterial | undefined,
): SceneMaterial {
  const copy = structuredClone(material);
  delete copy.appearance;
  return other?.appearance ? { ...copy, appearance: other.appearance } : copy;
}
