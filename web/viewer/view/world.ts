import { Box3, Group, Vector3 } from 'three';
import type { Ray } from 'three';
import { BodyKind } from '../../client/index';
import type { BodyKindName, Frame, SessionDescription, Vector } from '../../client/index';
import { BodyView, isGrid } from './body_view';
import { Ground } from './ground';
import type { Theme } from './palette';
import { floorUniforms } from './shadow_material';
import { VatView } from './vat_view';

/** A particle under the pointer. */
export interface Picked {
  body: number;
  particle: number;
  position: Vector3;
}

/** Everything that a session shows: its bodies, its vat, and the ground below. */
export class World {
  readonly group = new Group();
  private readonly ground: Ground;
  private readonly floor = floorUniforms();
  private bodies = new Map<number, BodyView>();
  private vat: VatView | undefined;
  private description: SessionDescription | undefined;
  /** Where the vat has been or, without one, where the bodies were at first. */
  private seen = new Box3();

  constructor(private look: Theme) {
    this.ground = new Ground(look);
    this.group.add(this.ground.mesh);
    this.paint(look);
  }

  /** Replaces the bodies and the vat by those described. */
  describe(description: SessionDescription): void {
    this.clear();
    this.description = description;
    const counts: Record<BodyKindName, number> = { liquid: 0, deformable: 0, rigid: 0 };
    for (const body of description.bodies) {
      const view = new BodyView(body, counts[body.kind]++, this.floor);
      this.bodies.set(body.body, view);
      this.group.add(view.group);
    }
    if (description.vat) {
      this.vat = new VatView(description.vat, this.look);
      this.group.add(this.vat.group);
      this.moveVat([0, 0, 0]);
      this.ground.fit(this.seen);
    }
  }

  /** Returns false for a frame of another epoch, which this world cannot show. */
  show(frame: Frame): boolean {
    if (frame.header.epoch !== this.description?.epoch) return false;
    for (const block of frame.blocks) {
      if (block.kind === BodyKind.vat) this.moveVat(block.offset);
      else if (isGrid(block)) this.bodies.get(block.body)?.showGrid(block, frame.header);
      else this.bodies.get(block.body)?.showPose(block);
    }
    if (this.seen.isEmpty()) this.settle();
    return true;
  }

  /** What a camera should see; the slides of a vat are known only once they were seen. */
  get bounds(): Box3 {
    return this.seen;
  }

  pick(ray: Ray): Picked | undefined {
    let nearest: Picked | undefined;
    let distance = Infinity;
    for (const [body, view] of this.bodies) {
      const hit = view.pick(ray);
      const position = hit && view.positionOf(hit.particle);
      if (!position || hit.distance >= distance) continue;
      distance = hit.distance;
      nearest = { body, particle: hit.particle, position };
    }
    return nearest;
  }

  /** Where a particle is now and its radius; undefined once it or its body is gone. */
  particle(body: number, particle: number): { position: Vector3; radius: number } | undefined {
    const view = this.bodies.get(body);
    const position = view?.positionOf(particle);
    return view && position && { position, radius: view.description.radius };
  }

  paint(look: Theme): void {
    this.look = look;
    this.ground.paint(look);
    this.vat?.paint(look);
    this.floor.floor_colour.value.copy(look.floor);
    this.floor.shadow_colour.value.copy(look.shadow);
  }

  private moveVat(offset: Vector): void {
    const vat = this.description?.vat;
    if (!vat || !this.vat) return;
    this.vat.moveTo(offset);
    this.vat.expand(this.seen);
    const [x, y, z] = offset;
    this.floor.floor_z.value = vat.min[2] + z;
    this.floor.reach.value = 0.6 * (vat.max[2] - vat.min[2]);
    this.floor.floor_bounds.value.set(
      vat.min[0] + x,
      vat.min[1] + y,
      vat.max[0] + x,
      vat.max[1] + y,
    );
  }

  /** Without a vat the bodies say, as they are now, where to look and where the ground is. */
  private settle(): void {
    for (const view of this.bodies.values()) view.expand(this.seen);
    if (!this.seen.isEmpty()) this.ground.fit(this.seen);
  }

  private clear(): void {
    this.seen.makeEmpty();
    for (const view of this.bodies.values()) view.dispose();
    this.bodies = new Map();
    this.vat?.dispose();
    this.vat = undefined;
  }
}
