import { Box3, Vector3 } from 'three';

/** The space of an object, relative to its centre. */
export interface Footprint {
  readonly box: Box3;
  /** Returns whether a particle at `place` with this radius [m] touches the object. */
  touches(place: Vector3, radius: number): boolean;
}

/** Objects at rest on each other overlap slightly. Larger shares of the touching distance are free. */
const kTouch = 0.9;

export function ballOf(radius: number): Footprint {
  return {
    box: cube(radius),
    touches: (place, other) => place.lengthSq() < (radius + other) ** 2,
  };
}

/** Returns a cube of this side [m]. */
export function blockOf(side: number): Footprint {
  const box = cube(side / 2);
  return { box, touches: (place, other) => box.distanceToPoint(place) < other };
}

/** Returns particles of this radius [m]. */
export function cloudOf(places: readonly Vector3[], radius: number): Footprint {
  const cell = 2 * radius;
  const cells = new Map<string, Vector3[]>();
  const at = (x: number): number => Math.floor(x / cell);
  for (const place of places) {
    const key = `${at(place.x)} ${at(place.y)} ${at(place.z)}`;
    cells.set(key, [...(cells.get(key) ?? []), place]);
  }
  const touches = (place: Vector3, other: number): boolean => {
    const reach = kTouch * (radius + other);
    const isNear = (one: Vector3): boolean => one.distanceToSquared(place) < reach ** 2;
    for (let x = at(place.x - reach); x <= at(place.x + reach); ++x) {
      for (let y = at(place.y - reach); y <= at(place.y + reach); ++y) {
        for (let z = at(place.z - reach); z <= at(place.z + reach); ++z) {
          if (cells.get(`${x} ${y} ${z}`)?.some(isNear)) return true;
        }
      }
    }
    return false;
  };
  return { box: new Box3().setFromPoints([...places]).expandByScalar(radius), touches };
}

function cube(half: number): Box3 {
  return new Box3(new Vector3(-half, -half, -half), new Vector3(half, half, half));
}
