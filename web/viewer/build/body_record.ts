import type { BodyState, Params, Scene, SceneBody, Vector } from '../../client/index';

/** The data that restores a body. */
export type BodyRecord = Params<'world.add_body'>;

/** The maximum number of particles, with velocities, in a message. */
export const kMostParticles = 12_000;

/** Returns the motion of a body in the format of the protocol; undefined if it is too large. */
function motionOf(state: BodyState): BodyRecord['state'] {
  const { center_of_mass, orientation, velocity, angular_velocity } = state;
  if (center_of_mass && orientation && velocity && angular_velocity) {
    return { center_of_mass, orientation, velocity, angular_velocity };
  }
  if (state.positions.length > kMostParticles) return undefined;
  return { positions: state.positions, velocities: state.velocities };
}

/** Returns whether emitters or drains can have changed the body's particles. */
function hasFlowed({ emitters = [], drains = [] }: Scene, made: SceneBody): boolean {
  if (made.kind !== 'liquid') return false;
  return drains.length > 0 || emitters.some(({ body }) => body === made.name);
}

/** Returns the body as a list of particles at their present positions. */
function asParticles(made: SceneBody, { positions, velocities }: BodyState): SceneBody {
  const { name, kind, material, spacing, radius } = made;
  return {
    name,
    kind,
    material,
    ...(spacing !== undefined && { spacing }),
    ...(radius !== undefined && { radius }),
    shape: { type: 'particles', positions, velocities },
  };
}

/** Returns the body's description and state. `isWhole` is true if they are complete. */
export function recordOf(
  scene: Scene,
  made: SceneBody,
  state: BodyState,
): { record: BodyRecord; isWhole: boolean } {
  const motion = motionOf(state);
  if (!motion) return { record: { body: shifted(made, state.positions) }, isWhole: false };
  if (hasFlowed(scene, made)) return { record: { body: asParticles(made, state) }, isWhole: true };
  return { record: { body: made, state: motion }, isWhole: true };
}

/** Returns the body in its initial shape at its present position. */
function shifted(made: SceneBody, positions: readonly Vector[]): SceneBody {
  if (made.shape.type === 'particles') return made;
  const { center } = made.shape as { center?: Vector };
  const middle = mean(positions);
  return { ...made, position: middle.map((x, q) => x - (center?.[q] ?? 0)) as Vector };
}

export function mean(places: readonly Vector[]): Vector {
  const sum = places.reduce<Vector>(
    (total, place) => total.map((x, axis) => x + place[axis]!) as Vector,
    [0, 0, 0],
  );
  return sum.map((x) => x / Math.max(places.length, 1)) as Vector;
}
