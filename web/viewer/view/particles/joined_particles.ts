import { Color, Float32BufferAttribute, Group, InstancedBufferAttribute, Mesh } from 'three';
import { InstancedBufferGeometry } from 'three';
import type { BufferGeometry, ShaderMaterial } from 'three';
import type { LookUniforms } from '../colour/look_uniforms';
import { kLayers } from '../base/layers';
import { bodyUniforms } from './impostor';
import { kSquare, kSquareTriangles } from './particle_columns';
import { shadowMaterial } from './shadow_material';
import type { FloorUniforms } from './shadow_material';
import { sphereMaterial } from './sphere_material';

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
    const uniforms = bodyUniforms(new Color(), shared.look, false);
    this.joined = {
      spots: new Joined(shadowMaterial(1, shared.floor, uniforms), 1),
      spheres: new Joined(sphereMaterial(uniforms, 1), 2),
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

/** The particles of several bodies as instances of one mesh. */
class Joined {
  readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;
  private known = '';
  private hidden: Mesh[] = [];

  constructor(material: ShaderMaterial, order: number) {
    this.mesh = new Mesh(new InstancedBufferGeometry() as BufferGeometry, material);
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
    this.mesh.geometry.dispose();
    if (this.mesh.visible) this.mesh.geometry = instancesOf(bodies);
  }
}

function instancesOf(bodies: readonly RigidParticles[]): InstancedBufferGeometry {
  const count = bodies.reduce((sum, { places }) => sum + places.length / 3, 0);
  const centres = new Float32Array(3 * count);
  const numbers = new Uint32Array(count);
  const rows = new Float32Array(count);
  let at = 0;
  for (const { places, row } of bodies) {
    centres.set(places, 3 * at);
    for (let i = 0; 3 * i < places.length; ++i, ++at) {
      numbers[at] = i;
      rows[at] = row + 1;
    }
  }
  const geometry = new InstancedBufferGeometry();
  geometry.setAttribute('position', new Float32BufferAttribute(kSquare, 3));
  geometry.setIndex([...kSquareTriangles]);
  const centre = new InstancedBufferAttribute(centres, 3);
  geometry.setAttribute('center', centre);
  geometry.setAttribute('before', centre); // rigid
  geometry.setAttribute('number', new InstancedBufferAttribute(numbers, 1));
  geometry.setAttribute('value', new InstancedBufferAttribute(new Int32Array(count), 1));
  geometry.setAttribute('row', new InstancedBufferAttribute(rows, 1));
  geometry.instanceCount = count;
  return geometry;
}
