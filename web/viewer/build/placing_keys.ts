import { Vector3 } from 'three';
import type { Keys } from '../panel/keys';
import type { View } from '../view/view';
import type { Placer } from './placer';

/** The displacement by a key, relative to the height of the scene. */
const kStep = 0.04;

/** Directions in camera axes: right, up, away. */
const kWays: Readonly<Record<string, readonly [number, number, number]>> = {
  arrowleft: [-1, 0, 0],
  arrowright: [1, 0, 0],
  arrowup: [0, 1, 0],
  arrowdown: [0, -1, 0],
  pageup: [0, 0, 1],
  pagedown: [0, 0, -1],
};

/** Adds the keys that move, place or cancel the object. While placing, they precede other keys. */
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
