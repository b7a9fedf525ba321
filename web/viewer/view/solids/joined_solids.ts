import { BufferAttribute, BufferGeometry, Color, Group, Mesh } from 'three';
import { kLayers } from '../base/layers';
import type { LookUniforms } from '../colour/look_uniforms';
import { bodyUniforms } from '../particles/impostor';
import { setFinish } from './solid';
import type { Joinable, SolidSurface } from './solid';
import { solidMaterial } from './solid_material';
import type { Surroundings } from './solid_material';

/** The attributes of solids with three coordinates per vertex. */
const kVectors = ['position', 'normal', 'rest'] as const;

/** As the order of solids in BodyView. */
const kOrder = 2;

/**
 * Draws all opaque rigid bodies with the same finish by one draw call. The vertices are in body
 * axes, and the table has the poses.
 */
export class JoinedSolids {
  readonly group = new Group();
  private members: Joinable[] = [];
  private known = '';

  constructor(private readonly shared: Surroundings & { look: LookUniforms }) {}

  /** Draws these bodies. Called before each picture. */
  update(bodies: readonly Joinable[]): void {
    const key = bodies.map(({ solid, row }) => `${solid.mesh.uuid} ${solid.finish} ${row}`).join();
    if (key !== this.known) this.rebuild(bodies);
    this.known = key;
  }

  dispose(): void {
    this.rebuild([]);
    this.group.removeFromParent();
  }

  private rebuild(bodies: readonly Joinable[]): void {
    for (const { solid } of this.members) showAlone(solid);
    for (const mesh of this.group.children as Mesh<BufferGeometry>[]) mesh.geometry.dispose();
    for (const mesh of this.group.children as Mesh[])
      (mesh.material as { dispose(): void }).dispose();
    this.group.clear();
    const byFinish = new Map<number, Joinable[]>();
    for (const body of bodies) {
      const { finish } = body.solid;
      byFinish.set(finish, [...(byFinish.get(finish) ?? []), body]);
    }
    this.members = [];
    for (const [finish, members] of byFinish) {
      if (members.length > 1) this.join(finish, members);
    }
  }

  private join(finish: number, members: readonly Joinable[]): void {
    const geometry = joinedGeometry(members);
    const uniforms = bodyUniforms(new Color(), this.shared.look, false);
    const material = solidMaterial(uniforms, this.shared, 1);
    setFinish(material, finish);
    const mesh = new Mesh(geometry, material);
    mesh.frustumCulled = false;
    mesh.renderOrder = kOrder;
    mesh.layers.enable(kLayers.casters);
    this.group.add(mesh);
    for (const { solid } of members) solid.mesh.layers.disableAll();
    this.members.push(...members);
  }
}

function showAlone({ mesh }: SolidSurface): void {
  mesh.layers.set(kLayers.scene);
  mesh.layers.enable(kLayers.casters);
}

/** Returns the geometries of solids as one, with their rows. */
function joinedGeometry(bodies: readonly Joinable[]): BufferGeometry {
  const parts = bodies.map(({ solid }) => solid.mesh.geometry);
  const counts = parts.map((part) => part.getAttribute('position').count);
  const total = counts.reduce((sum, count) => sum + count, 0);
  const columns = kVectors.map((name) => [name, new Float32Array(3 * total)] as const);
  const rows = new Float32Array(total);
  const triangles: number[] = [];
  let vertex = 0;
  parts.forEach((part, i) => {
    for (const [name, to] of columns) to.set(part.getAttribute(name).array, 3 * vertex);
    rows.fill(bodies[i]!.row + 1, vertex, vertex + counts[i]!);
    const index = part.getIndex();
    const corners = index ? index.count : counts[i]!;
    for (let c = 0; c < corners; ++c) triangles.push(vertex + (index ? index.getX(c) : c));
    vertex += counts[i]!;
  });
  const geometry = new BufferGeometry();
  for (const [name, values] of columns) geometry.setAttribute(name, new BufferAttribute(values, 3));
  geometry.setAttribute('before', geometry.getAttribute('position')); // rigid
  geometry.setAttribute('row', new BufferAttribute(rows, 1));
  geometry.setIndex(triangles);
  return geometry;
}
