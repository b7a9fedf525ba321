import { Vector3 } from 'three';
import type { Keys } from '../panel/keys';
import type { View } from '../view/view';
import type { Placer } from './placer';

/** Of the height of the scene: how far a key moves what is placed. */
const kStep = 0.04;

/** To the right, up, and away, as the camera sees it. */
const kWays: Readonly<Record<string, readonly [number, number, number]>> = {
  arrowleft: [-1, 0, 0],
  arrowright: [1, 0, 0],
  arrowup: [0, 1, 0],
  arrowdown: [0, -1, 0],
  pageup: [0, 0, 1],
  pagedown: [0, 0, -1],
};

/** Keys that move what is placed, put it down, or leave it; before all others while it lasts. */
export function addPlacingKeys(keys: Keys, placer: Placer, { stage, world }: View): void {
  const isEnabled = (): boolean => placer.isPlacing;
  keys.add({
    keys: Object.keys(kWays),
    repeats: true,
    act: (key) => {
      const [right, up, away] = kWays[key]!;
      const look = stage.viewDirection().setZ(0).normalize();
      const step = new Vector3(look.y, -look.x, 0)
        .multiplyScalar(right)
        .addScaledVector(look, away);
      placer.shift(step.setZ(up).multiplyScalar(kStep * world.height));
    },
    isEnabled,
  });
  keys.add({ keys: ['enter'], act: () => placer.confirm(), isEnabled });
  keys.add({ keys: ['escape'], act: () => placer.end(), isEnabled });
}
