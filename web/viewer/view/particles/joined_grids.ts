import { Color, Group, Mesh } from 'three';
import type { BufferGeometry, ShaderMaterial } from 'three';
import { kLayers } from '../base/layers';
import type { LookUniforms } from '../colour/look_uniforms';
import { bodyUniforms } from './impostor';
import type { DrawnUniforms } from './impostor';
import { JoinedColumns } from './joined_columns';
import type { GridBody } from './joined_columns';
import { shadowMaterial } from './shadow_material';
import type { FloorUniforms } from './shadow_material';
import { sphereMaterial } from './sphere_material';

/** The particles of a body with its own meshes, which are hidden while all are drawn together. */
export interface GridParticles extends GridBody {
  spheres: Mesh;
  spots: Mesh;
  /** Unit of the columns' values. */
  valueQuantum: number;
}

const kKinds = ['spots', 'spheres'] as const;
type Kind = (typeof kKinds)[number];

/**
 * Draws the particles of liquid and deformable bodies by one draw call for spheres and one for their
 * shadows.
 */
export class JoinedGrids {
  readonly group = new Group();
  private readonly uniforms;
  private readonly columns = { spots: new JoinedColumns(), spheres: new JoinedColumns() };
  private readonly meshes: Record<Kind, Mesh<BufferGeometry, ShaderMaterial>>;
  private hidden: Record<Kind, Mesh[]> = { spots: [], spheres: [] };

  constructor(shared: { look: LookUniforms; floor: FloorUniforms }) {
    this.uniforms = bodyUniforms(new Color(), shared.look, true);
    this.meshes = {
      spots: this.meshOf('spots', shadowMaterial(1, shared.floor, this.drawn('spots')), 1),
      spheres: this.meshOf('spheres', sphereMaterial(this.drawn('spheres'), 1), 2),
    };
    this.group.add(...kKinds.map((kind) => this.meshes[kind]));
  }

  /** Draws the visible particles of these bodies. Called before each picture. */
  update(bodies: readonly GridParticles[]): void {
    if (bodies[0]) this.uniforms.value_quantum.value = bodies[0].valueQuantum;
    for (const kind of kKinds) {
      const shown = bodies.filter((body) => body[kind].visible);
      const isJoined = shown.length > 1;
      this.meshes[kind].visible = isJoined;
      if (isJoined) this.columns[kind].update(shown);
      for (const { layers } of this.hidden[kind]) layers.set(kLayers.scene);
      this.hidden[kind] = isJoined ? shown.map((body) => body[kind]) : [];
      for (const { layers } of this.hidden[kind]) layers.disableAll();
    }
  }

  private drawn(kind: Kind): DrawnUniforms {
    return { ...this.uniforms, ...this.columns[kind].uniforms };
  }

  private meshOf(
    kind: Kind,
    material: ShaderMaterial,
    order: number,
  ): Mesh<BufferGeometry, ShaderMaterial> {
    const mesh = new Mesh(this.columns[kind].geometry, material);
    mesh.frustumCulled = false;
    mesh.renderOrder = order;
    mesh.visible = false;
    return mesh;
  }
}
