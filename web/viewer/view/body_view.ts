import {
  Group,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  Float32BufferAttribute,
  Matrix4,
  Mesh,
  Quaternion,
  Vector3,
} from 'three';
import type { Box3, Color, Ray, ShaderMaterial } from 'three';
import { BodyKind } from '../../client/index';
import type { BodyDescription, FrameHeader, GridBlock, PoseBlock } from '../../client/index';
import { nearestSphere } from '../grab/pick';
import type { Hit } from '../grab/pick';
import { kLiquidLayer } from './liquid_pass';
import { bodyColour } from './palette';
import { shadowMaterial } from './shadow_material';
import type { FloorUniforms } from './shadow_material';
import { sphereMaterial } from './sphere_material';
import { splatDepthMaterial, splatMaterial } from './splat_material';

/** Draw order: shadows on the floor, solids; of liquids the depth before the splats. */
const kOrder = { shadow: 1, solid: 2, splatDepth: 1, splat: 2 };

/** Of a particle's radius: splats overlap, so that a liquid closes up to one surface. */
const kSplatSize = 2;

const kGrowth = 1.5;

const kGloss = { deformable: 0.1, rigid: 0.35 };

/** For poses, which come with every frame. */
const kPlace = new Vector3();
const kTurn = new Quaternion();
const kOne = new Vector3(1, 1, 1);

/** 0, 1, 2, ... */
function plainNumbers(count: number): InstancedBufferAttribute {
  return new InstancedBufferAttribute(
    new Uint32Array(count).map((_, i) => i),
    1,
  );
}

/** Two triangles for each instance; `center` is the instance's place, `number` its particle's. */
function squares(
  centers: InstancedBufferAttribute,
  numbers: InstancedBufferAttribute,
): InstancedBufferGeometry {
  const geometry = new InstancedBufferGeometry();
  const corners = [-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0];
  geometry.setAttribute('position', new Float32BufferAttribute(corners, 3));
  geometry.setIndex([0, 1, 2, 0, 2, 3]);
  geometry.setAttribute('center', centers);
  geometry.setAttribute('number', numbers);
  return geometry;
}

/**
 * One body's particles. The group's matrix takes the particles' own coordinates to the world: grid
 * steps for liquid and deformable bodies, body axes for rigid ones; so a new frame costs one upload
 * of the integers received, or of nothing but a pose.
 */
export class BodyView {
  readonly group = new Group();
  private centers: InstancedBufferAttribute;
  /** Of the particles, rising; undefined: 0, 1, 2, ... */
  private numbers: Uint32Array | undefined;
  /** The same for the graphics, which tint particles by them. */
  private numberColumn: InstancedBufferAttribute;
  private readonly geometry: InstancedBufferGeometry;
  private readonly materials: ShaderMaterial[] = [];
  /** Takes positions that do not fill the graphics buffer; as long as that. */
  private copies: Uint16Array | undefined;

  constructor(
    readonly description: BodyDescription,
    nthOfKind: number,
    floor: FloorUniforms,
  ) {
    const local = description.local_positions;
    this.centers = local
      ? new InstancedBufferAttribute(new Float32Array(local), 3)
      : new InstancedBufferAttribute(new Uint16Array(3 * description.particles), 3);
    this.numberColumn = plainNumbers(this.centers.count);
    this.geometry = squares(this.centers, this.numberColumn);
    this.count = this.centers.count;
    this.group.matrixAutoUpdate = false;
    this.group.visible = false; // until the first frame
    this.add(shadowMaterial(description.radius, floor), kOrder.shadow);
    this.addParticles(bodyColour(description.kind, nthOfKind));
  }

  /** How many particles there are now: a liquid body may grow and shrink. */
  get count(): number {
    return this.geometry.instanceCount;
  }

  private set count(count: number) {
    this.geometry.instanceCount = count;
  }

  /**
   * Shows the block's positions as they are where their number stays: no copy is made, and they and
   * their numbers must stay as they are until the next call.
   */
  showGrid(block: GridBlock, { origin, quantum }: FrameHeader): void {
    const { positions } = block;
    const wasNumbered = this.numbers !== undefined;
    this.numbers = block.numbers;
    this.count = positions.length / 3;
    const room = this.centers.array.length;
    if (positions.length === room) this.centers.array = positions;
    else if (positions.length < room) this.copy(positions, room);
    else this.grow(positions);
    this.centers.needsUpdate = true;
    if (wasNumbered || this.numbers) this.showNumbers();
    this.group.matrix.makeScale(quantum, quantum, quantum).setPosition(...origin);
    this.shown();
  }

  showPose({ position, orientation }: PoseBlock): void {
    const [w, x, y, z] = orientation;
    this.group.matrix.compose(kPlace.set(...position), kTurn.set(x, y, z, w), kOne);
    this.shown();
  }

  /** The particle that the ray meets first, by its number, and its distance in metres. */
  pick(ray: Ray): Hit | undefined {
    if (!this.group.visible) return undefined;
    const scale = this.group.matrix.getMaxScaleOnAxis();
    const local = ray.clone().applyMatrix4(new Matrix4().copy(this.group.matrix).invert());
    local.direction.normalize();
    const places = this.centers.array.subarray(0, 3 * this.count);
    const hit = nearestSphere(local, places, this.description.radius / scale);
    if (!hit) return undefined;
    const particle = this.numbers?.[hit.particle] ?? hit.particle;
    return { particle, distance: hit.distance * scale };
  }

  private copy(positions: Uint16Array, room: number): void {
    this.copies ??= new Uint16Array(room);
    this.copies.set(positions);
    this.centers.array = this.copies;
  }

  /** Graphics buffers keep their length: a longer one takes the place of the old, with room. */
  private grow(positions: Uint16Array): void {
    this.copies = new Uint16Array(3 * Math.ceil(kGrowth * (positions.length / 3)));
    this.copies.set(positions);
    this.geometry.dispose(); // frees the old buffer
    this.centers = new InstancedBufferAttribute(this.copies, 3);
    this.geometry.setAttribute('center', this.centers);
    this.numberColumn = plainNumbers(this.centers.count);
    this.geometry.setAttribute('number', this.numberColumn);
  }

  /** They are sent to the graphics only where they have changed. */
  private showNumbers(): void {
    const { numbers, count } = this;
    const shown = this.numberColumn.array as Uint32Array;
    for (let i = 0; i < count; ++i) {
      const number = numbers ? numbers[i]! : i;
      if (shown[i] === number) continue;
      shown[i] = number;
      this.numberColumn.needsUpdate = true;
    }
  }

  /** World position of the particle with this number; undefined where it is not shown. */
  positionOf(particle: number): Vector3 | undefined {
    const place = this.numbers ? placeIn(this.numbers, particle) : particle;
    return place !== undefined && place < this.count ? this.positionAt(place) : undefined;
  }

  private positionAt(place: number): Vector3 {
    return new Vector3().fromArray(this.centers.array, 3 * place).applyMatrix4(this.group.matrix);
  }

  /** Makes the box hold all particles. */
  expand(box: Box3): void {
    if (!this.group.visible) return;
    for (let i = 0; i < this.count; ++i) box.expandByPoint(this.positionAt(i));
    box.expandByScalar(this.description.radius);
  }

  dispose(): void {
    this.group.removeFromParent();
    this.geometry.dispose();
    for (const material of this.materials) material.dispose();
  }

  private addParticles(colour: Color): void {
    const { kind, radius } = this.description;
    if (kind === 'liquid') {
      const look = { colour, radius: kSplatSize * radius };
      this.add(splatDepthMaterial(look), kOrder.splatDepth, kLiquidLayer);
      this.add(splatMaterial(look), kOrder.splat, kLiquidLayer);
    } else {
      this.add(sphereMaterial({ colour, radius, gloss: kGloss[kind] }), kOrder.solid);
    }
  }

  private add(material: ShaderMaterial, order: number, layer = 0): void {
    const mesh = new Mesh(this.geometry, material);
    mesh.frustumCulled = false; // the geometry's own bounds say nothing about its instances
    mesh.renderOrder = order;
    mesh.layers.set(layer);
    this.group.add(mesh);
    this.materials.push(material);
  }

  private shown(): void {
    this.group.matrixWorldNeedsUpdate = true;
    this.group.visible = true;
  }
}

/** Where a value is in rising ones. */
function placeIn(values: Uint32Array, value: number): number | undefined {
  let low = 0;
  let high = values.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((values[middle] as number) < value) low = middle + 1;
    else high = middle;
  }
  return values[low] === value ? low : undefined;
}

export function isGrid(block: { kind: number }): block is GridBlock {
  return block.kind === BodyKind.liquid || block.kind === BodyKind.deformable;
}
