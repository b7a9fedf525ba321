import { Vector3 } from 'three';
import type { Box3, Matrix4 } from 'three';

/** The particles of a solid. */
export interface SolidParticles {
  places: ArrayLike<number>;
  count: number;
  /** From the coordinates of `places` to world axes [m]. */
  toWorld: Matrix4;
  /** Particle radius [m]. */
  radius: number;
}

/** Places in the same grid as those of a liquid. Each represents some liquid particles. */
export interface NeighbourPlaces {
  places: number[];
  weights: number[];
}

/**
 * Returns the particles of solids that are at most `reach` from a liquid within `box`. `fromWorld`
 * converts world axes to the grid of the liquid, with its unit for `box`, `reach` and `radius`, the
 * radius of the liquid's particles. Only a part of many small particles is returned.
 */
export function solidsNear(
  solids: readonly SolidParticles[],
  fromWorld: Matrix4,
  box: Box3,
  reach: number,
  radius: number,
): NeighbourPlaces {
  const found: NeighbourPlaces = { places: [], weights: [] };
  const near = box.clone().expandByScalar(reach);
  const scale = fromWorld.getMaxScaleOnAxis();
  const place = new Vector3();
  for (const { places, count, toWorld, radius: own } of solids) {
    const toGrid = toWorld.clone().premultiply(fromWorld);
    const volume = ((scale * own) / radius) ** 3;
    const every = Math.max(Math.floor(1 / volume), 1);
    for (let i = 0; i < count; i += every) {
      place.fromArray(places, 3 * i).applyMatrix4(toGrid);
      if (!near.containsPoint(place)) continue;
      found.places.push(place.x, place.y, place.z);
      found.weights.push(every * volume);
    }
  }
  return found;
}
