import { BufferGeometry, Color, Group, Mesh } from 'three';
import type { ShaderMaterial } from 'three';
import type { LookUniforms } from '../colour/look_uniforms';
import { kLayers } from '../base/layers';
import { bodyUniforms, kSquareVertices } from './impostor';
import type { BodyUniforms, DrawnUniforms } from './impostor';
import { shadowMaterial } from './shadow_material';
import type { FloorUniforms } from './shadow_material';
import { sphereMaterial } from './sphere_material';
import { Texels, particleUniforms, texelsAt } from './texels';
import type { ParticleUniforms } from './texels';

/** The particles of a rigid body. */
export interface RigidParticles {
  /** The row in the table of bodies, from 0 on. */
  row: number;
  /** Positions in body axes, as a flat list. */
  places: readonly number[];
  /** The body's own meshes, which are hidden while the particles are drawn together. */
  spheres: Mesh;
  spots: Mesh;
}

const kKinds = ['spots', 'spheres'] as const;
type Kind = (typeof kKinds)[number];

/** Draws the particles of all rigid bodies by one draw call for spheres and one for their shadows. */
export class JoinedParticles {
  readonly group = new Group();
  private readonly joined: Record<Kind, Joined>;

  constructor(shared: { look: LookUniforms; floor: FloorUniforms }) {
    const body = bodyUniforms(new Color(), shared.look, false);
    this.joined = {
      spots: new Joined(body, (uniforms) => shadowMaterial(1, shared.floor, uniforms), 1),
      spheres: new Joined(body, (uniforms) => sphereMaterial(uniforms, 1), 2),
    };
    this.group.add(...kKinds.map((kind) => this.joined[kind].mesh));
  }

  /** Draws the visible particles of these bodies. Called before each picture. */
  update(bodies: readonly RigidParticles[]): void {
    for (const kind of kKinds) {
      const shown = bodies.filter((body) => body[kind].visible);
      this.joined[kind].update(shown, (body) => body[kind]);
    }
  }
}

/** The particles of several bodies as one mesh. */
class Joined {
  readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
  readonly uniforms: ParticleUniforms = particleUniforms();
  private known = '';
  private hidden: Mesh[] = [];

  constructor(
    body: BodyUniforms,
    material: (uniforms: DrawnUniforms) => ShaderMaterial,
    order: number,
  ) {
    this.mesh = new Mesh(new BufferGeometry(), material({ ...body, ...this.uniforms }));
    this.mesh.frustumCulled = false;
    this.mesh.renderOrder = order;
    this.mesh.visible = false;
  }

  update(bodies: readonly RigidParticles[], own: (body: RigidParticles) => Mesh): void {
    const key = bodies.map((body) => `${own(body).uuid} ${body.row}`).join();
    if (key === this.known) return;
    this.known = key;
    for (const { layers } of this.hidden) layers.set(kLayers.scene);
    this.mesh.visible = bodies.length > 1;
    this.hidden = this.mesh.visible ? bodies.map(own) : [];
    for (const { layers } of this.hidden) layers.disableAll();
    if (this.mesh.visible) this.write(bodies);
  }

  private write(bodies: readonly RigidParticles[]): void {
    const count = bodies.reduce((sum, { places }) => sum + places.length / 3, 0);
    const names = Texels.names(count);
    let at = 0;
    for (const { places, row } of bodies) {
      for (let i = 0; 3 * i < places.length; ++i, ++at) names.values.set([i, row + 1], 2 * at);
    }
    const { places, grid } = texelsAt(bodies.flatMap((body) => [...body.places]));
    const { uniforms } = this;
    uniforms.center_texels.value.dispose();
    uniforms.name_texels.value.dispose();
    uniforms.center_texels.value = uniforms.before_texels.value = places.texture; // rigid
    uniforms.texel_grid.value = grid;
    uniforms.name_texels.value = names.texture;
    this.mesh.geometry.setDrawRange(0, kSquareVertices * count);
  }
}
