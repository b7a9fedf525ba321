import { Box3, BufferAttribute, BufferGeometry, DynamicDrawUsage } from 'three';
import type { SceneShape } from '../../../client/index';
import type { BodyUniforms } from '../particles/impostor';
import { BoundSurface, writeNormals } from './bound_surface';
import { Lattice } from './lattice';
import { Solid, withRest } from './solid';
import type { ShownParticles, SolidSurface } from './solid';
import type { Surroundings } from './solid_material';

/** Pause between two surfaces of a tearing body / time to make one. */
const kPause = 4;

/** A deformable body at rest: its particles in the axes of its shape. */
export interface RestBody {
  shape: SceneShape;
  spacing: number;
  places: readonly number[];
}

/** The surface of a deformable body. It bends, stretches and tears with the particles. */
export class BoundSolid extends Solid implements SolidSurface {
  private readonly lattice: Lattice;
  private readonly box: Box3;
  private surface: BoundSurface;
  /** The quantum of the vertices, while the next frame continues the motion. */
  private quantum: number | undefined;
  private time = -Infinity;
  /** Whether links have torn since the surface was made. */
  private isStale = false;
  /** The time from which the surface may be made anew [ms]. */
  private nextRebuild = 0;

  constructor(
    private readonly body: RestBody,
    uniforms: BodyUniforms,
    surroundings: Surroundings,
  ) {
    const lattice = new Lattice(body.places, body.spacing);
    const surface = new BoundSurface(lattice, body.places, body.shape);
    const box = new Box3().setFromArray(surface.rest);
    super(geometryOf(surface, box), box, uniforms, surroundings);
    this.lattice = lattice;
    this.surface = surface;
    this.box = box;
  }

  follow({ columns, quantum, time, tearingStrain, values }: ShownParticles): void {
    if (columns.count !== this.lattice.count) return;
    const unit = this.body.spacing / quantum;
    const places = columns.coordinates(1);
    const isMended = time < this.time && this.lattice.mend();
    this.time = time;
    const isTorn =
      tearingStrain !== undefined && this.lattice.tear(places, (1 + tearingStrain) * unit);
    this.isStale ||= isTorn;
    const now = performance.now();
    if (isMended || (this.isStale && now >= this.nextRebuild)) {
      this.rebuild();
      this.nextRebuild = now + kPause * (performance.now() - now);
    }
    const [position, before, normal, amount] = ['position', 'before', 'normal', 'amount'].map(
      (name) => this.mesh.geometry.getAttribute(name) as BufferAttribute,
    ) as [BufferAttribute, BufferAttribute, BufferAttribute, BufferAttribute];
    const vertices = position.array as Float32Array;
    if (this.quantum === quantum) (before.array as Float32Array).set(vertices);
    else this.surface.follow(columns.coordinates(0), unit, before.array as Float32Array);
    this.quantum = quantum;
    this.surface.follow(places, unit, vertices);
    writeNormals(vertices, this.surface.mesh.triangles, normal.array as Float32Array);
    for (const attribute of [position, before, normal]) attribute.needsUpdate = true;
    if (!values) return;
    for (let i = 0; i < amount.count; ++i) amount.setX(i, values[this.surface.particleOf(i)] ?? 0);
    amount.needsUpdate = true;
  }

  rest(): void {
    this.quantum = undefined;
  }

  /** Makes the surface anew after links have torn. */
  private rebuild(): void {
    this.isStale = false;
    this.surface = new BoundSurface(this.lattice, this.body.places, this.body.shape);
    this.mesh.geometry.dispose();
    this.mesh.geometry = geometryOf(this.surface, this.box);
    this.rest();
  }
}

function geometryOf(surface: BoundSurface, box: Box3): BufferGeometry {
  const geometry = new BufferGeometry();
  const column = (): BufferAttribute => {
    const attribute = new BufferAttribute(surface.rest.slice(), 3);
    return attribute.setUsage(DynamicDrawUsage);
  };
  geometry.setAttribute('position', column());
  geometry.setIndex(new BufferAttribute(surface.mesh.triangles, 1));
  withRest(geometry, box);
  geometry.setAttribute('before', column());
  geometry.setAttribute('normal', column());
  return geometry;
}
