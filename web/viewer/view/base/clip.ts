import type { Box3, Vector4 } from 'three';
import type { ViewSettings } from './settings';

const kAxes = ['x', 'y', 'z'] as const;

/** Sets the clip plane p · xyz = w from the settings, at its position in the box. */
export function setClipPlane(
  plane: Vector4,
  { clip, clipAt = 0.5, clipOther }: Pick<ViewSettings, 'clip' | 'clipAt' | 'clipOther'>,
  box: Box3,
): void {
  plane.set(0, 0, 0, 1);
  if (clip === 'off' || box.isEmpty()) return;
  const sign = clipOther ? -1 : 1;
  const at = box.min[clip] + clipAt * (box.max[clip] - box.min[clip]);
  plane.setComponent(kAxes.indexOf(clip), sign);
  plane.setComponent(3, sign * at);
}
