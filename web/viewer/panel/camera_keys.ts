import { turned } from '../view/base/pose';
import type { Pose } from '../view/base/pose';
import type { Keys } from './keys';

/** The camera functions that keys control. */
export interface Camera {
  readonly canvas: HTMLElement;
  pose: Pose;
}

const kStep = Math.PI / 36;
const kZoom = 1.1;

const kTurns: Readonly<Record<string, readonly [right: number, up: number]>> = {
  arrowleft: [-kStep, 0],
  arrowright: [kStep, 0],
  arrowup: [0, kStep],
  arrowdown: [0, -kStep],
};

/** Adds keys that rotate and zoom the view. Arrows act only if the picture has the focus. */
export function addCameraKeys(keys: Keys, camera: Camera, home: () => void): void {
  keys.add({
    keys: Object.keys(kTurns),
    sign: '← ↑ ↓ →',
    words: 'turn the view, if it has the focus',
    repeats: true,
    on: camera.canvas,
    act: (key) => {
      const [right, up] = kTurns[key] ?? [0, 0];
      camera.pose = turned(camera.pose, right, up, 1);
    },
  });
  keys.add({
    keys: ['+', '=', '-'],
    sign: '+ −',
    words: 'zoom in and out',
    repeats: true,
    act: (key) => (camera.pose = turned(camera.pose, 0, 0, key === '-' ? 1 / kZoom : kZoom)),
  });
  keys.add({ keys: ['f'], sign: 'F', words: 'show the whole scene', act: home });
}
