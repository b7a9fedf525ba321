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
import type { Box3, Ray, ShaderMaterial } from 'three';
import { BodyKind } from '../../client/index';
import type { BodyDescription, FrameHeader, GridBlock, PoseBlock } from '../../client/index';
import { nearestSphere } from '../grab/pick';
import type { Hit } from '../grab/pick';
import { bodyColour } from './palette';
import { shadowMaterial } from './shadow_material';
import type { FloorUniforms } from './shadow_material';
import { sphereDepthMaterial, sphereMaterial } from './sphere_material';
import type { SphereLook } from './sphere_material';

/** Draw order: shadows on the floor, solids, the liquid's depth, its colour. */
const kOrder = { shadow: 1, solid: 2, liquidDepth: 3, liquid: 4 };

/** Liquid spheres are drawn larger, so that they close up to one surface. */
const kLiquidSwelling = 1.3;

function lookOf(description: BodyDescription, nthOfKind: number): SphereLook {
  const isLiquid = description.kind === 'liquid';
  return {
    color: bodyColour(description.kind, nthOfKind),
    radius: description.radius * (isLiquid ? kLiquidSwelling : 1),
    gloss: isLiquid ? 1 : description.kind === 'rigid' ? 0.35 : 0.1,
    opacity: isLiquid ? 0.86 : 1,
  };
}

/** Two triangles for each instance; `center` is the instance's place. */
function squares(centers: InstancedBufferAttribute): InstancedBufferGeometry {
  const geometry = new InstancedBufferGeometry();
  const corners = [-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0];
  geometry.setAttribute('position', new Float32BufferAttribute(corners, 3));
  geometry.setIndex([0, 1, 2, 0, 2, 3]);
  geometry.setAttribute('center', centers);
  geometry.instanceCount = centers.count;
  return geometry;
}

/**
 * One body's particles. The group's matrix takes the particles' own coordinates to the world: grid
 * steps for liquid and deformable bodies, body axes for rigid ones; so a new frame costs one upload
 * of the integers received, or of nothing but a pose.
 */
export class BodyView {
  readonly group = new Group();
  private readonly centers: InstancedBufferAttribute;
  private readonly geometry: InstancedBufferGeometry;
  private readonly materials: ShaderMaterial[] = [];

  constructor(
    readonly description: BodyDescription,
    nthOfKind: number,
    floor: FloorUniforms,
  ) {
    const local = description.local_positions;
    this.centers = local
      ? new InstancedBufferAttribute(new Float32Array(local), 3)
      : new InstancedBufferAttribute(new Uint16Array(3 * description.particles), 3);
    this.geometry = squares(this.centers);
    this.group.matrixAutoUpdate = false;
    this.group.visible = false; // until the first frame
    const look = lookOf(description, nthOfKind);
    this.add(shadowMaterial(look.radius, floor), kOrder.shadow);
    if (look.opacity < 1) {
      this.add(sphereDepthMaterial(look), kOrder.liquidDepth).transparent = true;
      this.add(sphereMaterial(look), kOrder.liquid);
    } else {
      this.add(sphereMaterial(look), kOrder.solid);
    }
  }

  /** Takes the block's positions as they are: no copy is made. */
  showGrid(block: GridBlock, { origin, quantum }: FrameHeader): void {
    if (block.positions.length !== this.centers.array.length) return;
    this.centers.array = block.positions;
    this.centers.needsUpdate = true;
    this.group.matrix.makeScale(quantum, quantum, quantum).setPosition(...origin);
    this.shown();
  }

  showPose({ position, orientation }: PoseBlock): void {
    const [w, x, y, z] = orientation;
    const one = new Vector3(1, 1, 1);
    this.group.matrix.compose(new Vector3(...position), new Quaternion(x, y, z, w), one);
    this.shown();
  }

  /** The particle that the ray meets first, its distance in metres. */
  pick(ray: Ray): Hit | undefined {
    if (!this.group.visible) return undefined;
    const scale = this.group.matrix.getMaxScaleOnAxis();
    const local = ray.clone().applyMatrix4(new Matrix4().copy(this.group.matrix).invert());
    local.direction.normalize();
    const hit = nearestSphere(local, this.centers.array, this.description.radius / scale);
    return hit && { particle: hit.particle, distance: hit.distance * scale };
  }

  /** World position of a particle. */
  positionOf(particle: number): Vector3 {
    return new Vector3()
      .fromArray(this.centers.array, 3 * particle)
      .applyMatrix4(this.group.matrix);
  }

  /** Makes the box hold all particles. */
  expand(box: Box3): void {
    if (!this.group.visible) return;
    for (let i = 0; i < this.centers.count; ++i) box.expandByPoint(this.positionOf(i));
    box.expandByScalar(this.description.radius);
  }

  dispose(): void {
    this.group.removeFromParent();
    this.geometry.dispose();
    for (const material of this.materials) material.dispose();
  }

  private add(material: ShaderMaterial, order: number): ShaderMaterial {
    const mesh = new Mesh(this.geometry, material);
    mesh.frustumCulled = false; // the geometry's own bounds say nothing about its instances
    mesh.renderOrder = order;
    this.group.add(mesh);
    this.materials.push(material);
    return material;
  }

  private shown(): void {
    this.group.matrixWorldNeedsUpdate = true;
    this.group.visible = true;
  }
}

export function isGrid(block: { kind: number }): block is GridBlock {
  return block.kind === BodyKind.liquid || block.kind === BodyKind.deformable;
}
