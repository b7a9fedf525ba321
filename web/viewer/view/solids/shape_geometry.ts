import { BufferAttribute, BufferGeometry, LatheGeometry, Quaternion, SphereGeometry } from 'three';
import { Vector2, Vector3 } from 'three';
import { toCreasedNormals } from 'three/examples/jsm/utils/BufferGeometryUtils.js';
import type { SceneShape } from '../../../client/index';

/** Radius of bevels / smallest size of the shape. */
const kBevel = 0.05;
/** The maximum number of segments of a bevel, a quarter of a circle. */
const kMostBevel = 3;

/** Limits of the number of segments of spheres and cylinders around their axes. */
const kLeastAround = 12;
const kMostAround = 64;

/** Edges of meshes with a larger angle between their faces are sharp [rad]. */
const kCrease = 0.6;

type Of<T extends SceneShape['type']> = Extract<SceneShape, { type: T }>;

/**
 * Returns the surface of a shape; undefined for particles, which have no surface. `error` is the
 * distance between curved surfaces and their triangles that is not visible [m]; 0: the finest.
 */
export function geometryOf(shape: SceneShape, error = 0): BufferGeometry | undefined {
  switch (shape.type) {
    case 'box':
      return boxGeometry(shape, error);
    case 'sphere':
      return sphereGeometry(shape, error);
    case 'cylinder':
      return cylinderGeometry(shape, error);
    case 'mesh':
      return meshGeometry(shape);
    default:
      return undefined;
  }
}

/** Returns the number of segments of a circle, a multiple of 4, that are within `error` of it. */
export function segmentsOf(radius: number, error: number): number {
  const angle = Math.acos(1 - Math.min(error / radius, 1)); // half of a segment's
  const quarter = angle > 0 ? Math.ceil(Math.PI / angle / 4) : Infinity;
  return Math.min(Math.max(4 * quarter, kLeastAround), kMostAround);
}

function bevelSegmentsOf(bevel: number, error: number): number {
  const angle = Math.acos(1 - Math.min(error / bevel, 1));
  return Math.min(angle > 0 ? Math.max(Math.ceil(Math.PI / 4 / angle), 1) : Infinity, kMostBevel);
}

/**
 * The surface of a ball whose eight parts are moved apart to the corners. The triangles between the
 * parts are the faces and the edges.
 */
function boxGeometry({ size, center = [0, 0, 0] }: Of<'box'>, error: number): BufferGeometry {
  const bevel = kBevel * Math.min(...size);
  const segments = bevelSegmentsOf(bevel, error);
  const [x, y, z] = size.map((length) => length / 2 - bevel) as [number, number, number];
  const rows = bevelPoints(2, segments); // from the lower face to the upper one
  const columns = bevelPoints(4, segments);
  const positions = new Float32Array(3 * rows.length * columns.length);
  const normals = new Float32Array(positions.length);
  const triangles: number[] = [];
  let at = 0;
  rows.forEach(({ bevel: half, cos: down, sin: out }, row) => {
    columns.forEach(({ bevel: quarter, cos, sin }, column) => {
      const east = quarter === 0 || quarter === 3 ? x : -x;
      const north = quarter < 2 ? y : -y;
      const up = half === 1 ? z : -z;
      normals.set([out * cos, out * sin, -down], at);
      positions[at] = center[0] + east + bevel * out * cos;
      positions[at + 1] = center[1] + north + bevel * out * sin;
      positions[at + 2] = center[2] + up - bevel * down;
      at += 3;
      if (row + 1 === rows.length) return;
      const here = row * columns.length + column;
      const beside = row * columns.length + ((column + 1) % columns.length);
      const above = columns.length;
      triangles.push(here, beside, here + above, beside, beside + above, here + above);
    });
  });
  // The lower and the upper face: at a pole, each quarter is one corner.
  const top = (rows.length - 1) * columns.length;
  const b = columns.length / 4;
  const c = 2 * b;
  const d = 3 * b;
  triangles.push(0, c, b, 0, d, c, top, top + b, top + c, top, top + c, top + d);
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(positions, 3));
  geometry.setAttribute('normal', new BufferAttribute(normals, 3));
  geometry.setIndex(triangles);
  return geometry;
}

/** Returns the points of this number of successive bevels, each a quarter of a circle. */
function bevelPoints(bevels: number, segments: number) {
  return Array.from({ length: bevels * (segments + 1) }, (_, point) => {
    const bevel = Math.floor(point / (segments + 1));
    const angle = (Math.PI / 2) * (bevel + (point % (segments + 1)) / segments);
    return { bevel, cos: Math.cos(angle), sin: Math.sin(angle) };
  });
}

function sphereGeometry(
  { radius, center = [0, 0, 0] }: Of<'sphere'>,
  error: number,
): BufferGeometry {
  const around = segmentsOf(radius, error);
  return new SphereGeometry(radius, around, around / 2).translate(...center);
}

function cylinderGeometry(shape: Of<'cylinder'>, error: number): BufferGeometry {
  const { radius, height, axis = [0, 0, 1], center = [0, 0, 0] } = shape;
  const bevel = kBevel * Math.min(2 * radius, height);
  const segments = bevelSegmentsOf(bevel, error);
  const outline = [new Vector2(0, -height / 2)];
  // The profile of the lower and the upper bevel. Double points at their ends keep the caps flat.
  for (const side of [-1, 1]) {
    for (let i = 0; i <= segments; ++i) {
      const step = side < 0 ? i : segments - i;
      const angle = (Math.PI / 2) * (step / segments);
      const x = radius - bevel + bevel * Math.sin(angle);
      outline.push(new Vector2(x, side * (height / 2 - bevel + bevel * Math.cos(angle))));
    }
  }
  outline.push(new Vector2(0, height / 2));
  const turn = new Quaternion().setFromUnitVectors(
    new Vector3(0, 1, 0),
    new Vector3(...axis).normalize(),
  );
  return toCreasedNormals(new LatheGeometry(outline, segmentsOf(radius, error)), kCrease)
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
