import { Box3 } from 'three';
import { BodiesBox, framedBox } from './base/framed';
import type { BodyView } from './bodies/body_view';

/** A liquid whose lowest particles are nearer to the floor covers it [particle radii]. */
const kAtFloor = 2;

/** The maximum number of particles of a body that are measured in each frame. */
const kSample = 100;

/** The extent of a scene's bodies, and the part of the scene that the camera shows. */
export class Contents {
  /** The extent of the bodies in the first frame. */
  readonly first = new Box3();
  /** The extent of the bodies in the last frame. */
  readonly extent = new Box3();
  private readonly room = new BodiesBox();
  /** Whether the camera follows the bodies. It does not if the walls of the vat hold them. */
  private followsBodies = false;

  /**
   * Follows the bodies in a frame, `seconds` after the previous one. `vat` is empty without a vat,
   * and `lid` is whether it is closed.
   */
  follow(bodies: readonly BodyView[], vat: Box3, lid: boolean, seconds: number): void {
    if (this.first.isEmpty()) {
      this.first.copy(extentOf(bodies));
      const liquids = bodies.filter(({ description }) => description.kind === 'liquid');
      const isHeld = liquids.length > 0 ? liquids.some((body) => isAtFloor(body, vat)) : lid;
      this.followsBodies = !vat.isEmpty() && !isHeld;
    }
    this.extent.copy(extentOf(bodies, kSample));
    if (this.followsBodies) this.room.follow(vat, this.extent, seconds);
  }

  /** Returns the box for the camera in a scene of this extent. */
  framedIn(scene: Box3): Box3 {
    const { box } = this.room;
    return box.isEmpty() ? framedBox(scene, this.first) : box;
  }

  clear(): void {
    this.first.makeEmpty();
    this.room.clear();
    this.followsBodies = false;
  }
}

/** `most`: the number of particles of each body that count. */
function extentOf(bodies: readonly BodyView[], most = Infinity): Box3 {
  const box = new Box3();
  for (const { places } of bodies) places.expand(box, most);
  return box;
}

function isAtFloor(body: BodyView, vat: Box3): boolean {
  const { radius } = body.description;
  const box = extentOf([body]);
  return !box.isEmpty() && box.min.z < vat.min.z + kAtFloor * radius;
}
