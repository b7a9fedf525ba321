import { BufferAttribute, BufferGeometry, LatheGeometry, Quaternion, SphereGeometry } from 'three';
import { Vector2, Vector3 } from 'three';
import { RoundedBoxGeometry } from 'three/examples/jsm/geometries/RoundedBoxGeometry.js';
import { toCreasedNormals } from 'three/examples/jsm/utils/BufferGeometryUtils.js';
import type { SceneShape } from '../../../client/index';

/** Radius of bevels / smallest size of the shape. */
const kBevel = 0.05;
const kBevelSegments = 3;

/** Segments of spheres and cylinders around their axes. */
const kAround = 64;

/** Edges of meshes with a larger angle between their faces are sharp [rad]. */
const kCrease = 0.6;

type Of<T extends SceneShape['type']> = Extract<SceneShape, { type: T }>;

/** Returns the surface of a shape; undefined for particles, which have no surface. */
export function geometryOf(shape: SceneShape): BufferGeometry | undefined {
  switch (shape.type) {
    case 'box':
      return boxGeometry(shape);
    case 'sphere':
      return sphereGeometry(shape);
    case 'cylinder':
      return cylinderGeometry(shape);
    case 'mesh':
      return meshGeometry(shape);
    default:
      return undefined;
  }
}

function boxGeometry({ size, center = [0, 0, 0] }: Of<'box'>): BufferGeometry {
  const bevel = kBevel * Math.min(...size);
  return new RoundedBoxGeometry(...size, kBevelSegments, bevel).translate(...center);
}

function sphereGeometry({ radius, center = [0, 0, 0] }: Of<'sphere'>): BufferGeometry {
  return new SphereGeometry(radius, kAround, kAround / 2).translate(...center);
}

function cylinderGeometry(shape: Of<'cylinder'>): BufferGeometry {
  const { radius, height, axis = [0, 0, 1], center = [0, 0, 0] } = shape;
  const bevel = kBevel * Math.min(2 * radius, height);
  const outline = [new Vector2(0, -height / 2)];
  // The profile of the lower and the upper bevel. Double points at their ends keep the caps flat.
  for (const side of [-1, 1]) {
    for (let i = 0; i <= kBevelSegments; ++i) {
      const step = side < 0 ? i : kBevelSegments - i;
      const angle = (Math.PI / 2) * (step / kBevelSegments);
      const x = radius - bevel + bevel * Math.sin(angle);
      outline.push(new Vector2(x, side * (height / 2 - bevel + bevel * Math.cos(angle))));
    }
  }
  outline.push(new Vector2(0, height / 2));
  const turn = new Quaternion().setFromUnitVectors(
    new Vector3(0, 1, 0),
    new Vector3(...axis).normalize(),
  );
  return toCreasedNormals(new LatheGeometry(outline, kAround), kCrease)
    .applyQuaternion(turn)
    .translate(...center);
}

function meshGeometry(shape: Of<'mesh'>): BufferGeometry | undefined {
  if (!('vertices' in shape)) return undefined; // descriptions contain no files
  const { vertices, triangles } = shape;
  const geometry = new BufferGeometry();
  const positions = new Float32Array(vertices.flat());
  geometry.setAttribute('position', new BufferAttribute(positions, 3));
  geometry.setIndex(triangles.flat());
  return toCreasedNormals(geometry, kCrease);
}
