import { Vector3 } from 'three';
import { ballOf } from '../view/base/footprint';
import type { World } from '../view/world';

/** The number of tried positions per axis. */
const kPlaces = 7;

/**
 * Returns the centre of a free ball of this radius [m] directly below the top, as close to the
 * centre of the scene as possible.
 */
export function placeFor(world: World, radius: number): Vector3 | undefined {
  const { min, max } = world.extent;
  const middle = world.extent.getCenter(new Vector3());
  const z = max.z - radius;
  const reach = (low: number, high: number): number[] => {
    const room = high - low - 2 * radius;
    if (room < 0) return [];
    return Array.from({ length: kPlaces }, (_, n) => low + radius + (n / (kPlaces - 1)) * room);
  };
  const places = reach(min.x, max.x).flatMap((x) =>
    reach(min.y, max.y).map((y) => new Vector3(x, y, z)),
  );
  const away = (place: Vector3): number => Math.hypot(place.x - middle.x, place.y - middle.y);
  places.sort((a, b) => away(a) - away(b));
  const ball = ballOf(radius);
  return places.find((place) => world.isFree(place, ball));
}
