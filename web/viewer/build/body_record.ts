import type { BodyState, Params, Scene, SceneBody, Vector } from '../../client/index';

/** A body as it was at a time: how to make it again. */
export type BodyRecord = Params<'world.add_body'>;

/** So many particles have room in a message, with their velocities. */
export const kMostParticles = 12_000;

/** Where a body is, and how it moves, as the server takes it; undefined where it is too large. */
function motionOf(state: BodyState): BodyRecord['state'] {
  const { center_of_mass, orientation, velocity, angular_velocity } = state;
  if (center_of_mass && orientation && velocity && angular_velocity) {
    return { center_of_mass, orientation, velocity, angular_velocity };
  }
  if (state.positions.length > kMostParticles) return undefined;
  return { positions: state.positions, velocities: state.velocities };
}

/** Taps and drains have changed which particles it has. */
function hasFlowed({ emitters = [], drains = [] }: Scene, made: SceneBody): boolean {
  if (made.kind !== 'liquid') return false;
  return drains.length > 0 || emitters.some(({ body }) => body === made.name);
}

/** The same as particles, each where it is. */
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

/** The body as the scene describes it, and as it is now; `isWhole`: nothing of that is lost. */
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

/** In its first shape, but where it is now. */
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
