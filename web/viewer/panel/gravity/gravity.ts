import type { Vector } from '../../../client/index';
import { Newest } from '../../stream/newest';
import { BallPad } from './ball_pad';
import { element, onPress } from '../elements';

/** Strength of gravity [m/s²] and its angles from vertical [degrees]. */
export interface Tilt {
  strength: number;
  x: number;
  y: number;
}

/** An angle along a horizontal unit vector. */
export interface LeanPart {
  degrees: number;
  along: readonly [number, number];
}

/** The maximum angle on each axis [degrees]. */
export const kMostTilt = 60;
const kRadians = Math.PI / 180;

/** Returns gravity of this strength along (tan x, tan y, -1). */
export function gravityOf({ strength, x, y }: Tilt): Vector {
  const [sx, sy] = [Math.tan(x * kRadians), Math.tan(y * kRadians)];
  const scale = strength / Math.hypot(sx, sy, 1);
  return [sx * scale, sy * scale, -scale].map((value) => value + 0) as Vector;
}

/** Returns the inverse of gravityOf for downward gravity. */
export function tiltOf([x, y, z]: Vector): Tilt {
  const strength = Math.hypot(x, y, z);
  const lean = (side: number): number =>
    strength === 0
      ? 0
      : Math.min(Math.max(Math.atan2(side, Math.abs(z)) / kRadians, -kMostTilt), kMostTilt);
  return { strength, x: lean(x), y: lean(y) };
}

/** The control of gravity: a slider of strength, and a pad or two sliders of direction. */
export class Gravity {
  private readonly strength = element('gravity', HTMLInputElement);
  private readonly text = element('gravity-text', HTMLOutputElement);
  private readonly pad = new BallPad(
    'tilt',
    () => this.isEnabled,
    ([x, y]) =>
      this.change({ ...this.tilt, x: Math.round(kMostTilt * x), y: Math.round(kMostTilt * y) }),
  );
  private readonly sliders = {
    x: element('tilt-x', HTMLInputElement),
    y: element('tilt-y', HTMLInputElement),
  };
  private readonly resetButton = element('gravity-reset', HTMLButtonElement);
  private tilt: Tilt = { strength: 9.81, x: 0, y: 0 };
  private initial: Vector = [0, 0, -9.81];
  private isEnabled = false;
  private readonly newest: Newest<Vector>;

  /** `send` resolves after the server's reply. Until then, only the newest value is stored. */
  constructor(send: (gravity: Vector) => Promise<unknown>) {
    this.newest = new Newest(send);
    for (const slider of [this.strength, this.sliders.x, this.sliders.y]) {
      slider.addEventListener('input', () => this.readSliders());
    }
    onPress(this.resetButton, () => this.change(tiltOf(this.initial)));
  }

  enable(enabled: boolean): void {
    this.isEnabled = enabled;
    const { strength, sliders, resetButton } = this;
    for (const control of [strength, sliders.x, sliders.y, resetButton]) {
      control.disabled = !enabled;
    }
  }

  /** Displays the session's gravity. `isNew`: a scene was loaded. */
  describe(gravity: Vector, isNew: boolean): void {
    if (isNew) this.initial = gravity;
    if (this.pad.isDragging || this.newest.isBusy) return; // a newer value is pending
    this.tilt = tiltOf(gravity);
    this.show();
  }

  /** The present gravity, including a change that the server has not answered yet. */
  get present(): Readonly<Tilt> {
    return this.tilt;
  }

  /** Tilts gravity along horizontal unit vectors, relative to `from`; by default, to vertical. */
  lean(parts: readonly LeanPart[], from: Pick<Tilt, 'x' | 'y'> = { x: 0, y: 0 }): void {
    const sum = (axis: 0 | 1): number =>
      parts.reduce((total, { degrees, along }) => total + degrees * along[axis], 0);
    const within = (value: number): number =>
      Math.round(Math.min(Math.max(value, -kMostTilt), kMostTilt));
    this.change({ ...this.tilt, x: within(from.x + sum(0)), y: within(from.y + sum(1)) });
  }

  private readSliders(): void {
    const { x, y } = this.sliders;
    this.change({
      strength: this.strength.valueAsNumber,
      x: x.valueAsNumber,
      y: y.valueAsNumber,
    });
  }

  /** Shows and sends a gravity. */
  change(tilt: Readonly<Tilt>): void {
    this.tilt = tilt;
    this.show();
    this.newest.put(gravityOf(tilt));
  }

  private show(): void {
    const { strength, x, y } = this.tilt;
    this.strength.valueAsNumber = strength;
    this.sliders.x.valueAsNumber = x;
    this.sliders.y.valueAsNumber = y;
    this.text.value = `${strength.toFixed(2)} m/s²`;
    this.pad.show([x / kMostTilt, y / kMostTilt]);
  }
}
