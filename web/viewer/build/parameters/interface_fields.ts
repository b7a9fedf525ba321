import type { Scene, SceneInterface } from '../../../client/index';
import type { ValueSpec } from './value_field';

export type Law = NonNullable<SceneInterface['law']>;

export const kLaws: Readonly<Record<Law, string>> = {
  penalty: 'springs and friction',
  projection: 'no overlap, with friction',
  lennard_jones: 'adhesive layer',
  sph: 'the liquid’s pressure',
};

/** The name of the walls in interfaces. */
export const kVat = 'vat';

type Field = ValueSpec & { name: string; usual?: number };

const field = (name: string, label: string, unit: string, min: number, max: number): Field => ({
  id: `contact-${name}`,
  name,
  label,
  unit,
  min,
  max,
});

const kStiffness = field('stiffness', 'Stiffness', 'N/m', 0, 1e12);
const kDamping = { ...field('damping', 'Damping', 'N s/m', 0, 1e12), usual: 0 };
const kFriction = { ...field('friction', 'Friction', 'Coulomb coefficient', 0, 10), usual: 0 };
const kThreshold = {
  ...field(
    'threshold',
    'Threshold',
    'm, distance below which particles repel each other',
    1e-6,
    1e6,
  ),
  otherwise: 'sum of the particle radii',
};
const kReach = { ...field('reach', 'Reach', 'thresholds', 1.1, 4), usual: 2 };
const kRestitution = field('restitution', 'Restitution', 'separation speed / approach speed', 0, 1);
const kAngle = { ...field('contact_angle', 'Contact angle', 'degrees', 30, 150), usual: 90 };

/** Returns the constants of an interface that SCENE.md defines. */
export function fieldsOf(scene: Scene, interface_: SceneInterface): readonly Field[] {
  const { law = 'penalty' } = interface_;
  const isTense = scene.materials.some(({ liquid }) => (liquid?.surface_tension ?? 0) > 0);
  const angle = isTense ? [kAngle] : [];
  if (law === 'sph') return angle;
  if (law === 'lennard_jones') return [kStiffness, kReach, kThreshold, ...angle];
  if (law === 'projection') {
    return [kFriction, { ...kRestitution, usual: 0 }, kThreshold, ...angle];
  }
  const isElastic = valueOf(interface_, 'restitution') !== undefined;
  const loss = isElastic ? { ...kRestitution, min: 0.05 } : kDamping;
  return [kStiffness, loss, kFriction, kThreshold, ...angle];
}

/** Returns a constant; undefined if it is absent. */
export function valueOf(interface_: SceneInterface | undefined, name: string): number | undefined {
  const value = (interface_ as Record<string, unknown> | undefined)?.[name];
  return typeof value === 'number' ? value : undefined;
}

/** Returns the interface with another value of a constant, or without it. */
export function withConstant(
  interface_: SceneInterface,
  name: string,
  value: number | undefined,
): SceneInterface {
  const others = Object.entries(interface_).filter(([key]) => key !== name);
  const changed = value === undefined ? others : [...others, [name, value]];
  return Object.fromEntries(changed) as SceneInterface;
}

type Pair = readonly [string, string];

/** Returns the scene's interface of two materials; undefined if the default applies. */
export function ownInterface(scene: Scene, [a, b]: Pair): SceneInterface | undefined {
  return scene.interfaces?.find(
    ({ materials: [c, d] }) => (a === c && b === d) || (a === d && b === c),
  );
}

/** Returns the interface of two materials. */
export function interfaceOf(scene: Scene, pair: Pair): SceneInterface {
  const own = ownInterface(scene, pair);
  if (own) return own;
  const materials: [string, string] = [...pair];
  const isLiquid = scene.materials.some(({ name, liquid }) => liquid && pair.includes(name));
  if (isLiquid && scene.pressure_solver !== 'gas') return { law: 'sph', materials };
  return { ...(scene.default_interface ?? { stiffness: 1000, damping: 1 }), materials };
}

/** Returns the interface with another law. Keeps the constants that both laws have. */
export function withLaw(scene: Scene, interface_: SceneInterface, law: Law): SceneInterface {
  const { materials } = interface_;
  const friction = valueOf(interface_, 'friction');
  const threshold = valueOf(interface_, 'threshold');
  const common = {
    materials,
    ...(threshold !== undefined && { threshold }),
    ...(friction !== undefined && { friction }),
  };
  const usual = scene.default_interface;
  const stiffness =
    valueOf(interface_, 'stiffness') ?? (usual && 'stiffness' in usual ? usual.stiffness : 1000);
  if (law === 'sph') return { law, materials };
  if (law === 'projection') return { ...common, law };
  if (law === 'penalty') return { ...common, law, stiffness };
  return { law, materials, stiffness, ...(threshold !== undefined && { threshold }) };
}
