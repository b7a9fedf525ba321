import { BufferAttribute, DoubleSide, FrontSide, Matrix4, Mesh, Vector3 } from 'three';
import type { Box3, BufferGeometry, ShaderMaterial } from 'three';
import { kLayers } from '../base/layers';
import type { BodyUniforms } from '../particles/impostor';
import type { ParticleColumns } from '../particles/particle_columns';
import { grainOf, solidMaterial } from './solid_material';
import type { Surroundings } from './solid_material';

/** The particles of a frame, for a surface that follows them. */
export interface ShownParticles {
  columns: ParticleColumns;
  /** Length of a unit of the columns [m]. */
  quantum: number;
  /** Simulated time of the frame [s]. */
  time: number;
  /** The strain at which links tear; undefined: they do not. */
  tearingStrain: number | undefined;
  /** The coloured quantity. */
  values: Float32Array | undefined;
}

/** The surface of a solid. */
export interface SolidSurface {
  readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
  /** 0: transparent, 1: opaque. */
  opacity: number;
  /** The index in kFinishes. */
  finish: number;
  /** The longest side [m]. */
  readonly bodyLength: number;
  /** Follows the particles of a frame. */
  follow?(particles: ShownParticles): void;
  /** Ends the interpolation: the next frame does not continue the motion. */
  rest?(): void;
  dispose(): void;
}

/** The surface of a rigid body that can be drawn together with those of others. */
export interface Joinable {
  /** The row in the table of bodies, from 0 on. */
  row: number;
  solid: SolidSurface;
}

/** A surface of constant form. That of a rigid body moves with the body's group. */
export class Solid implements SolidSurface {
  readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
  readonly bodyLength: number;

  /** `box` is the extent of the surface at rest. See withRest() for the geometry. */
  constructor(
    geometry: BufferGeometry,
    box: Box3,
    uniforms: BodyUniforms,
    surroundings: Surroundings,
  ) {
    this.bodyLength = grainOf(box).length;
    this.mesh = new Mesh(geometry, solidMaterial(uniforms, surroundings, this.bodyLength));
    this.mesh.frustumCulled = false;
    this.mesh.visible = false;
    this.mesh.layers.enable(kLayers.casters);
  }

  get opacity(): number {
    return this.mesh.material.uniforms.opacity!.value as number;
  }

  set opacity(opacity: number) {
    const { material } = this.mesh;
    material.uniforms.opacity!.value = opacity;
    material.transparent = opacity < 1;
    material.side = opacity < 1 ? FrontSide : DoubleSide; // a cut shows the inside
  }

  get finish(): number {
    return this.mesh.material.defines.FINISH as number;
  }

  set finish(finish: number) {
    setFinish(this.mesh.material, finish);
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}

/** Sets the index in kFinishes of a material of solidMaterial(). */
export function setFinish(material: ShaderMaterial, finish: number): void {
  if (finish === material.defines.FINISH) return;
  material.defines.FINISH = finish;
  material.needsUpdate = true;
}

/**
 * Adds the attributes of solidMaterial() to a geometry with positions and normals. The positions at
 * rest are relative to the centre, in the axes of the grain and in lengths of the longest side.
 */
export function withRest(geometry: BufferGeometry, box: Box3): BufferGeometry {
  const positions = geometry.getAttribute('position');
  const middle = box.getCenter(new Vector3());
  const toRest = new Matrix4()
    .setFromMatrix3(grainOf(box).toGrain)
    .multiply(new Matrix4().makeTranslation(middle.negate()));
  geometry.setAttribute('rest', positions.clone().applyMatrix4(toRest));
  geometry.setAttribute('before', positions);
  geometry.setAttribute('amount', new BufferAttribute(new Float32Array(positions.count), 1));
  return geometry;
}
