import { Vector3 } from 'three';
import type { Box3, PerspectiveCamera } from 'three';

/** A position in camera axes: right, up, and back towards the eye. */
export interface Seen {
  right: number;
  up: number;
  back: number;
}

/**
 * Returns the nearest eye position that has all points in view, with half-widths `side` and `rise` of
 * the view per unit of distance.
 *
 * A point is in view if |right - eye.right| <= side * (eye.back - point.back), and likewise for up.
 * The two bounds of each axis give the centre, and the stricter axis gives the distance.
 */
export function nearestEye(points: readonly Seen[], side: number, rise: number): Seen {
  const most = (value: (point: Seen) => number): number => Math.max(...points.map(value));
  const toRight = most(({ right, back }) => right + side * back);
  const toLeft = most(({ right, back }) => -right + side * back);
  const above = most(({ up, back }) => up + rise * back);
  const below = most(({ up, back }) => -up + rise * back);
  return {
    right: (toRight - toLeft) / 2,
    up: (above - below) / 2,
    back: Math.max((toRight + toLeft) / (2 * side), (above + below) / (2 * rise)),
  };
}

/**
 * Returns the target and the distance of a camera in the direction `from` (a unit vector) that has
 * the box in view. `margin` 1.1 leaves 10 % more space than needed.
 */
export function fitBox(
  box: Box3,
  from: Vector3,
  { up, fov, aspect }: PerspectiveCamera,
  margin: number,
): { target: Vector3; distance: number } {
  const toRight = new Vector3().crossVectors(up, from).normalize();
  const toTop = new Vector3().crossVectors(from, toRight);
  const middle = box.getCenter(new Vector3());
  const corners = cornersOf(box).map((corner) => {
    corner.sub(middle);
    return { right: corner.dot(toRight), up: corner.dot(toTop), back: corner.dot(from) };
  });
  const rise = Math.tan((fov * Math.PI) / 360) / margin;
  const eye = nearestEye(corners, rise * aspect, rise);
  const target = middle.addScaledVector(toRight, eye.right).addScaledVector(toTop, eye.up);
  return { target, distance: eye.back };
}

function cornersOf({ min, max }: Box3): Vector3[] {
  return [min.x, max.x].flatMap((x) =>
    [min.y, max.y].flatMap((y) => [min.z, max.z].map((z) => new Vector3(x, y, z))),
  );
}
