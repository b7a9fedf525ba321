import type {
  BodyKindName,
  Scene,
  SceneBody,
  SceneInterface,
  SceneMaterial,
} from '../../client/index';
import * as shipped from '../../../protocol/scenes/sliding-vat-liquid.json';
import { kSpacing, materialsFor } from './body_choice';

/** A catalogue scene that has a body of each kind and is stable at its step. */
const kModel = shipped as unknown as Scene;

const kKinds: readonly BodyKindName[] = ['liquid', 'deformable', 'rigid'];

/** The defaults in SCENE.md. */
const kDefaults = { step: 0.001, density: 1000, stiffness: 1000, damping: 1 };

/** A particle's mass [kg], the spacing [m], and the step [s]. */
interface Grain {
  mass: number;
  spacing: number;
  step: number;
}

/** Constants of a spring or a contact: stiffness [N/m], damping [N s/m]. */
interface Spring {
  stiffness: number;
  damping?: number;
}

/** Returns the scene with the model's materials whose names are not in use. */
export function withNewMaterials(scene: Scene): Scene {
  const taken = new Set(scene.materials.map(({ name }) => name));
  const added = kModel.materials.filter(({ name }) => !taken.has(name));
  return { ...scene, materials: [...scene.materials, ...added.map((one) => suited(scene, one))] };
}

/**
 * Returns the interfaces of a new material. Their stiffness, relative to particle mass and step, is
 * at most that of the model.
 */
export function newInterfaces(scene: Scene, material: SceneMaterial): SceneInterface[] {
  const { law = 'penalty', ...usual } = scene.default_interface ?? {};
  const isGas = scene.pressure_solver === 'gas';
  if (law !== 'penalty' || (material.liquid && !isGas)) return []; // liquids interact by pressure
  const { stiffness = kDefaults.stiffness } = usual as Partial<Spring>;
  const [from, to] = [grainOf(kModel, material.name), grainFor(scene, material)];
  const limit = scaled(kModel.default_interface as Spring, from, to);
  if (stiffness <= limit.stiffness) return [];
  const meets = ({ liquid }: SceneMaterial): boolean => isGas || !liquid;
  const others = scene.materials.filter(meets).map(({ name }) => name);
  if (!material.liquid) others.push(material.name); // a liquid has no interface with itself
  if (scene.vat) others.push('vat');
  return [...new Set(others)].map((other) => ({ materials: [material.name, other], ...limit }));
}

/** Scales a material to the particles and the step of this scene. */
function suited(scene: Scene, material: SceneMaterial): SceneMaterial {
  const [from, to] = [grainOf(kModel, material.name), grainFor(scene, material)];
  const made = structuredClone(material);
  if (made.liquid) {
    // The Courant numbers of sound and viscosity, per support radius, do not exceed the model's.
    const support = supportFor(scene, to.spacing);
    const way = (support / made.liquid.support_radius) * (from.step / to.step);
    made.liquid.support_radius = support;
    made.liquid.stiffness = rounded(made.liquid.stiffness * Math.min(1, way ** 2));
    const spread = way * (support / material.liquid!.support_radius);
    made.liquid.viscosity = rounded(made.liquid.viscosity * Math.min(1, spread));
  }
  for (const kind of ['structural', 'shear', 'bend'] as const) {
    const spring = made.springs?.[kind];
    if (spring) made.springs![kind] = asStiff(scene, spring, from, to);
  }
  if (made.self_contact) made.self_contact = scaled(made.self_contact, from, to);
  return made;
}

/** Returns springs as stiff as in the model, limited by the model's stability number. */
function asStiff(scene: Scene, spring: Spring, from: Grain, to: Grain): Spring {
  const size = scene.dimensions === 2 ? 1 / from.spacing : to.spacing / from.spacing;
  const most = scaled(spring, from, to);
  if (most.stiffness <= spring.stiffness * size) return most;
  const damping = (spring.damping ?? 0) * Math.sqrt((size * to.mass) / from.mass);
  return { stiffness: rounded(spring.stiffness * size), damping: rounded(damping) };
}

/** Returns springs with the same stiffness and damping relative to mass and step. */
function scaled({ stiffness, damping = 0 }: Spring, from: Grain, to: Grain): Required<Spring> {
  const mass = to.mass / from.mass;
  const rate = from.step / to.step;
  return {
    stiffness: rounded(stiffness * mass * rate ** 2),
    damping: rounded(damping * mass * rate),
  };
}

/** Returns the grain of the model's bodies of a material. */
function grainOf(scene: Scene, material: string): Grain {
  const body = scene.bodies.find((one) => one.material === material);
  const spacing = body?.spacing ?? kSpacing;
  const density = scene.materials.find(({ name }) => name === material)?.density;
  return grain(scene, density, spacing);
}

/** Returns the grain for bodies of a material that the scene does not use. */
function grainFor(scene: Scene, material: SceneMaterial): Grain {
  const kind = kKinds.find((one) => materialsFor({ ...scene, materials: [material] }, one).length);
  const isLiquid = kind === 'liquid';
  const filled = (body: SceneBody): boolean => body.spacing !== undefined;
  const alike = scene.bodies.find((body) => filled(body) && body.kind === kind);
  const spacing = (isLiquid ? undefined : alike?.spacing) ?? scene.bodies.find(filled)?.spacing;
  return grain(scene, material.density, spacing ?? kSpacing);
}

function grain(scene: Scene, density = kDefaults.density, spacing: number): Grain {
  const step = scene.numerics?.step ?? kDefaults.step;
  return { mass: density * spacing ** (scene.dimensions ?? 3), spacing, step };
}

/** Returns the common support radius of the scene's liquids, or the model's if there are none. */
function supportFor(scene: Scene, spacing: number): number {
  const there = scene.materials.find(({ liquid }) => liquid)?.liquid;
  const { liquid } = kModel.materials.find((one) => one.liquid)!;
  const ofModel = grainOf(kModel, kModel.materials.find((one) => one.liquid)!.name);
  return there?.support_radius ?? rounded((spacing * liquid!.support_radius) / ofModel.spacing);
}

/** Rounds to three significant digits. */
function rounded(value: number): number {
  return Number(value.toPrecision(3));
}
