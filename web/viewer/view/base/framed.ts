import { Box3, Vector3 } from 'three';

/** Space above the initial contents, relative to the height of the vat. */
const kAbove = 0.08;

/**
 * Returns the part of a vat that the first view shows: its floor and walls up to the contents at the
 * start. Solids remain in a part of the floor: they spread at most by about the height of their top.
 */
export function framedBox(vat: Box3, contents: Box3, hasLiquid: boolean): Box3 {
  const box = vat.clone();
  if (vat.isEmpty() || contents.isEmpty()) return box;
  const height = vat.max.z - vat.min.z;
  box.max.z = Math.min(vat.max.z, contents.max.z + kAbove * height);
  if (hasLiquid) return box;
  const spread = contents.max.z - vat.min.z;
  const part = contents.clone().expandByVector(new Vector3(spread, spread, 0));
  part.min.z = -Infinity;
  part.max.z = Infinity;
  const inside = box.clone().intersect(part);
  return inside.isEmpty() ? box : inside;
}
