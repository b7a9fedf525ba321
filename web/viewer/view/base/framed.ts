import type { Box3 } from 'three';

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
