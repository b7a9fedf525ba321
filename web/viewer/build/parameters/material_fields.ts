import type { SceneMaterial } from '../../../client/index';

/** A constant of a material that can change in a running scene. */
export interface MaterialField {
  /** The path of the member in the material. */
  path: readonly string[];
  label: string;
  unit: string;
  /** The range in SCENE.md. */
  min: number;
  max: number;
}

const kFields: readonly MaterialField[] = [
  { path: ['density'], label: 'Density', unit: 'kg/m³', min: 1e-6, max: 1e9 },
  {
    path: ['liquid', 'stiffness'],
    label: 'Stiffness (square of the speed of sound)',
    unit: 'm²/s²',
    min: 1e-6,
    max: 1e12,
  },
  { path: ['liquid', 'viscosity'], label: 'Viscosity', unit: 'Pa s', min: 0, max: 1e9 },
  { path: ['liquid', 'surface_tension'], label: 'Surface tension', unit: 'N/m', min: 0, max: 1e6 },
  ...(['structural', 'shear', 'bend'] as const).flatMap((kind) => [
    {
      path: ['springs', kind, 'stiffness'],
      label: `Springs (${kind}): stiffness`,
      unit: 'N/m',
      min: 0,
      max: 1e12,
    },
    {
      path: ['springs', kind, 'damping'],
      label: `Springs (${kind}): damping`,
      unit: 'N s/m',
      min: 0,
      max: 1e12,
    },
  ]),
  { path: ['bulk_modulus'], label: 'Bulk modulus', unit: 'Pa', min: 0, max: 1e12 },
  { path: ['tearing_strain'], label: 'Tearing strain', unit: '', min: 1e-6, max: 1000 },
];

/** Returns the constants that this material has. */
export function fieldsOf(material: SceneMaterial): readonly MaterialField[] {
  return kFields.filter(({ path }) => valueAt(material, path) !== undefined);
}

export function valueAt(material: SceneMaterial, path: readonly string[]): number | undefined {
  let at: unknown = material;
  for (const name of path) {
    if (typeof at !== 'object' || at === null) return undefined;
    at = (at as Record<string, unknown>)[name];
  }
  return typeof at === 'number' ? at : undefined;
}

/** Returns the material with another value at the path. */
export function withValue(
  material: SceneMaterial,
  path: readonly string[],
  value: number,
): SceneMaterial {
  const copy = structuredClone(material);
  const [last] = path.slice(-1);
  let at = copy as unknown as Record<string, unknown>;
  for (const name of path.slice(0, -1)) at = at[name] as Record<string, unknown>;
  at[last!] = value;
  return copy;
}
