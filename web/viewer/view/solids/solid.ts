import { BufferAttribute, DoubleSide, FrontSide, Mesh, Vector3 } from 'three';
import type { Box3, BufferGeometry, ShaderMaterial } from 'three';
import type { BodyUniforms } from '../particles/impostor';
import type { ParticleColumns } from '../particles/particle_columns';
import type { FloorUniforms } from '../particles/shadow_material';
import { solidMaterial } from './solid_material';

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
  /** Follows the particles of a frame. */
  follow?(particles: ShownParticles): void;
  /** Ends the interpolation: the next frame does not continue the motion. */
  rest?(): void;
  dispose(): void;
}

/** A surface of constant form. That of a rigid body moves with the body's group. */
export class Solid implements SolidSurface {
  readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;

  /** `box` is the extent of the surface at rest. See withRest() for the geometry. */
  constructor(geometry: BufferGeometry, box: Box3, uniforms: BodyUniforms, floor: FloorUniforms) {
    this.mesh = new Mesh(geometry, solidMaterial(uniforms, floor, box));
    this.mesh.frustumCulled = false;
    this.mesh.visible = false;
  }

  /** Sets the opacity: 0 transparent, 1 opaque. */
  set opacity(opacity: number) {
    const { material } = this.mesh;
    material.uniforms.opacity!.value = opacity;
    material.transparent = opacity < 1;
    material.side = opacity < 1 ? FrontSide : DoubleSide; // a cut shows the inside
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }
}

/** Adds the attributes of solidMaterial() to a geometry with positions and normals. */
export function withRest(geometry: BufferGeometry, box: Box3): BufferGeometry {
  const positions = geometry.getAttribute('position');
  const middle = box.getCenter(new Vector3());
  const rest = geometry.clone().translate(-middle.x, -middle.y, -middle.z);
  geometry.setAttribute('rest', rest.getAttribute('position'));
  geometry.setAttribute('before', positions);
  geometry.setAttribute('amount', new BufferAttribute(new Float32Array(positions.count), 1));
  return geometry;
}
