/** A straight line from `origin` along the unit vector `direction`. */
export interface Line {
  origin: { x: number; y: number; z: number };
  direction: { x: number; y: number; z: number };
}

export interface Hit {
  particle: number;
  /** Distance from the line's origin to the sphere's surface. */
  distance: number;
}

/** Returns the first sphere on the line. `centers` contains x, y, z of each in the line's units. */
export function nearestSphere(
  { origin, direction }: Line,
  centers: ArrayLike<number>,
  radius: number,
): Hit | undefined {
  let nearest: Hit | undefined;
  for (let i = 0; i + 2 < centers.length; i += 3) {
    const x = centers[i]! - origin.x;
    const y = centers[i + 1]! - origin.y;
    const z = centers[i + 2]! - origin.z;
    const along = x * direction.x + y * direction.y + z * direction.z;
    const miss2 = x * x + y * y + z * z - along * along;
    if (along < 0 || miss2 > radius * radius) continue;
    const distance = along - Math.sqrt(radius * radius - miss2);
    if (!nearest || distance < nearest.distance) nearest = { particle: i / 3, distance };
  }
  return nearest;
}
