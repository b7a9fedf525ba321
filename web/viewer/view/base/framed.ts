import { Box3 } from 'three';

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
