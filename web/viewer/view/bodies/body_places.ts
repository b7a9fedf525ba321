import { Box3, Vector3 } from 'three';
import type { Object3D } from 'three';
import { cloudOf } from '../base/footprint';
import type { Footprint } from '../base/footprint';
import type { BodyUniforms } from '../particles/impostor';
import type { ParticleColumns } from '../particles/particle_columns';

/** The maximum number of particles for the centre of a body. */
const kSample = 256;

/** The positions of a body's particles in the picture, in world axes. */
export class BodyPlaces {
  /** `group` has the transformation of the columns, and is visible if there is a picture. */
  constructor(
    private readonly columns: ParticleColumns,
    private readonly group: Object3D,
    private readonly uniforms: Pick<BodyUniforms, 'phase'>,
    private readonly radius: number,
  ) {}

  /** Returns the position of the i-th shown particle. */
  at(i: number): Vector3 {
    const phase = this.uniforms.phase.value;
    const q = (axis: number): number => this.columns.coordinate(3 * i + axis, phase);
    return new Vector3(q(0), q(1), q(2)).applyMatrix4(this.group.matrix);
  }

  /** Returns whether no particle touches a footprint centred at `middle`. */
  isFree(middle: Vector3, footprint: Footprint): boolean {
    if (!this.group.visible) return true;
    const { radius } = this;
    const box = footprint.box.clone().expandByScalar(radius);
    for (let i = 0; i < this.columns.count; ++i) {
      const place = this.at(i).sub(middle);
      if (box.containsPoint(place) && footprint.touches(place, radius)) return false;
    }
    return true;
  }

  /** Returns the particles relative to their mean position. */
  footprint(): Footprint {
    const places = this.all();
    const mean = meanOf(places);
    for (const place of places) place.sub(mean);
    return cloudOf(places, this.radius);
  }

  /** Returns the particle closest to the mean position. */
  middle(): { particle: number; position: Vector3 } | undefined {
    if (!this.group.visible || this.columns.count === 0) return undefined;
    const places = this.all();
    const mean = meanOf(places);
    const away = places.map((place) => place.distanceToSquared(mean));
    const nearest = away.reduce((best, value, i) => (value < away[best]! ? i : best), 0);
    return { particle: this.columns.numberAt(nearest), position: places[nearest]! };
  }

  /** Returns the mean position of a sample of the particles. */
  centre(): Vector3 | undefined {
    const { count } = this.columns;
    if (!this.group.visible || count === 0) return undefined;
    const every = Math.ceil(count / kSample);
    return meanOf(Array.from({ length: Math.ceil(count / every) }, (_, i) => this.at(i * every)));
  }

  /** Extends the box to contain all particles, or a sample of `most` of them. */
  expand(box: Box3, most = Infinity): void {
    const { count } = this.columns;
    if (!this.group.visible || count === 0) return;
    const every = Math.max(Math.ceil(count / most), 1);
    const own = new Box3();
    for (let i = 0; i < count; i += every) own.expandByPoint(this.at(i));
    box.union(own.expandByScalar(this.radius));
  }

  private all(): Vector3[] {
    return Array.from({ length: this.columns.count }, (_, i) => this.at(i));
  }
}

function meanOf(places: readonly Vector3[]): Vector3 {
  const sum = places.reduce((all, place) => all.add(place), new Vector3());
  return sum.divideScalar(Math.max(places.length, 1));
}
