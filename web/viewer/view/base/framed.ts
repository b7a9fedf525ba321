import { Box3, Vector3 } from 'three';

/** Space above the initial contents, relative to the height of the vat. */
const kAbove = 0.08;

/** Returns the part of a vat that the first view shows: up to the contents at the start. */
export function framedBox(vat: Box3, contents: Box3): Box3 {
  const box = vat.clone();
  if (vat.isEmpty() || contents.isEmpty()) return box;
  const height = vat.max.z - vat.min.z;
  box.max.z = Math.min(vat.max.z, contents.max.z + kAbove * height);
  return box;
}

/** Space beside bodies, relative to their width or depth, and the least width relative to the vat. */
const kBeside = 0.12;
const kLeastWidth = 0.25;

/** Time in which the view of bodies that come together shrinks to 1 / e [s]. */
const kShrinking = 0.5;

/**
 * The part of a vat around its bodies: it grows at once, so that all bodies remain in view, and
 * shrinks slowly.
 */
export class BodiesBox {
  readonly box = new Box3();

  /** Follows the bodies in a frame, `seconds` after the previous one. */
  follow(vat: Box3, bodies: Box3, seconds: number): void {
    if (bodies.isEmpty()) return;
    const wanted = roomOf(vat, bodies);
    if (this.box.isEmpty() || seconds < 0) this.box.copy(wanted);
    const rest = Math.exp(-seconds / kShrinking);
    this.box.min.lerp(wanted.min, 1 - rest).min(wanted.min);
    this.box.max.lerp(wanted.max, 1 - rest).max(wanted.max);
  }

  clear(): void {
    this.box.makeEmpty();
  }
}

/** Returns the part of a vat, from its floor on, with bodies and space around them. */
function roomOf(vat: Box3, bodies: Box3): Box3 {
  const size = vat.getSize(new Vector3());
  const room = bodies.clone();
  const width = bodies.getSize(new Vector3());
  const beside = new Vector3(
    Math.max(kBeside * width.x, (kLeastWidth * size.x - width.x) / 2),
    Math.max(kBeside * width.y, (kLeastWidth * size.y - width.y) / 2),
    kAbove * size.z,
  );
  room.min.sub(beside).max(vat.min);
  room.max.add(beside).min(vat.max);
  room.min.z = vat.min.z;
  return room;
}

/** The box that the camera keeps in view, until the camera is moved. */
export class Framing {
  /** Empty: the next box will be framed. */
  private current: Box3 | undefined = new Box3();

  /** The framed box; undefined before the first one, and after the camera was moved. */
  get box(): Box3 | undefined {
    return this.current?.isEmpty() ? undefined : this.current;
  }

  /** Frames the next box, also if the camera moves before it is known. */
  begin(): void {
    this.current = new Box3();
  }

  /** Called if the camera is moved. */
  end(): void {
    if (this.box) this.current = undefined;
  }

  /** Receives the box of each frame. Returns whether it is now framed and was not before. */
  follow(box: Box3): boolean {
    if (!this.current || box.isEmpty() || box.equals(this.current)) return false;
    this.current.copy(box);
    return true;
  }
}
