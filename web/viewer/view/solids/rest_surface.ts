import { Box3, Triangle, Vector3 } from 'three';
import type { SceneShape } from '../../../client/index';

/** Moves a point to the nearest point of a surface. */
export type Projection = (point: Vector3) => void;

/** Radius of bevels / spacing of the particles, and / smallest size of the shape. */
const kBevel = { spacing: 0.35, size: 0.2 };

type Of<T extends SceneShape['type']> = Extract<SceneShape, { type: T }>;

/**
 * Returns the projection to the surface of a shape with bevelled edges. `hull` is the extent of the
 * cells of its particles, which is mapped to that of a box. Undefined if the shape has no surface.
 */
export function projectionTo(
  shape: SceneShape,
  hull: Box3,
  spacing: number,
): Projection | undefined {
  switch (shape.type) {
    case 'box':
      return toBox(shape, hull, spacing);
    case 'sphere':
      return toSphere(shape);
    case 'cylinder':
      return toCylinder(shape, spacing);
    case 'mesh':
      return 'vertices' in shape ? toMesh(shape) : undefined;
    default:
      return undefined;
  }
}

function bevelOf(spacing: number, sizes: readonly number[]): number {
  return Math.min(kBevel.spacing * spacing, kBevel.size * Math.min(...sizes));
}

/**
 * Moves a point to the surface of a box around the origin whose edges are rounded. Coordinates can
 * be those of a plane too: of the profile of a cylinder.
 */
function roundOff(point: Vector3, half: Vector3, bevel: number): void {
  const inner = half.clone().subScalar(bevel);
  const nearest = point.clone().clamp(inner.clone().negate(), inner);
  const away = point.clone().sub(nearest);
  const distance = away.length();
  if (distance > 1e-9 * half.length()) {
    point.copy(nearest).addScaledVector(away, bevel / distance);
    return;
  }
  const depths = [0, 1, 2].map((q) => half.getComponent(q) - Math.abs(point.getComponent(q)));
  const q = depths.indexOf(Math.min(...depths));
  point.setComponent(q, (point.getComponent(q) < 0 ? -1 : 1) * half.getComponent(q));
}

function toBox({ size, center = [0, 0, 0] }: Of<'box'>, hull: Box3, spacing: number): Projection {
  const middle = new Vector3(...center);
  const half = new Vector3(...size).multiplyScalar(0.5);
  const from = hull.getCenter(new Vector3());
  const scale = half.clone().divide(hull.getSize(new Vector3()).multiplyScalar(0.5));
  const bevel = bevelOf(spacing, size);
  return (point) => {
    point.sub(from).multiply(scale);
    roundOff(point, half, bevel);
    point.add(middle);
  };
}

function toSphere({ radius, center = [0, 0, 0] }: Of<'sphere'>): Projection {
  const middle = new Vector3(...center);
  return (point) => {
    point.sub(middle).setLength(radius).add(middle);
  };
}

function toCylinder(shape: Of<'cylinder'>, spacing: number): Projection {
  const { radius, height, axis = [0, 0, 1], center = [0, 0, 0] } = shape;
  const middle = new Vector3(...center);
  const along = new Vector3(...axis).normalize();
  const bevel = bevelOf(spacing, [2 * radius, height]);
  // Distances in the third direction must not be the smallest.
  const half = new Vector3(radius, height / 2, radius + height);
  return (point) => {
    const z = point.sub(middle).dot(along);
    const outward = point.clone().addScaledVector(along, -z);
    const profile = new Vector3(outward.length(), z, 0);
    roundOff(profile, half, bevel);
    point.copy(outward).setLength(profile.x).addScaledVector(along, profile.y).add(middle);
  };
}

function toMesh({ vertices, triangles }: Extract<Of<'mesh'>, { vertices: unknown }>): Projection {
  const corners = vertices.map((vertex) => new Vector3(...vertex));
  const faces = triangles.map(([a, b, c]) => new Triangle(corners[a], corners[b], corners[c]));
  const boxes = faces.map(({ a, b, c }) => new Box3().setFromPoints([a, b, c]));
  return (point) => {
    let distance = Infinity;
    const nearest = point.clone();
    const found = new Vector3();
    faces.forEach((face, i) => {
      if (boxes[i]!.distanceToPoint(point) >= distance) return;
      face.closestPointToPoint(point, found);
      const away = found.distanceTo(point);
      if (away >= distance) return;
      distance = away;
      nearest.copy(found);
    });
    point.copy(nearest);
  };
}
