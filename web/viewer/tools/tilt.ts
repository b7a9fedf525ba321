import { Vector3 } from 'three';
import { gravityOf, kMostTilt } from '../panel/gravity/gravity';
import type { Gravity, LeanPart, Tilt } from '../panel/gravity/gravity';
import type { Keys } from '../panel/keys';
import type { HeldMarker } from '../view/held_marker';
import type { Stage } from '../view/stage';
import type { World } from '../view/world';

/** The tilt by an arrow key [degrees]. */
const kStep = 5;

/** Length of the arrow of gravity, and the size of its ends, relative to the scene's height. */
const kArrow = 0.4;
const kEnd = 0.03;

const kWays: Readonly<Record<string, readonly [right: number, away: number]>> = {
  arrowleft: [-1, 0],
  arrowright: [1, 0],
  arrowup: [0, 1],
  arrowdown: [0, -1],
};

/** Returns the parts of a tilt to the right of the picture and away from the viewer [degrees]. */
export function leanInView(right: number, away: number, look: Vector3): LeanPart[] {
  const { x, y } = look.clone().setZ(0).normalize();
  return [
    { degrees: right, along: [y, -x] },
    { degrees: away, along: [x, y] },
  ];
}

/** Tilts gravity while the pointer drags over the picture, or by arrow keys. */
export class TiltTool {
  /** Whether the pointer and the arrow keys tilt gravity. */
  private isActive = false;
  private press: { pointer: number; x: number; y: number } | undefined;
  /** Gravity before the tilt; undefined if it is not tilted by this tool. */
  private before: Tilt | undefined;
  /** The tilt by keys [degrees]. */
  private byKeys = { right: 0, away: 0 };

  /** `say` shows a temporary message. */
  constructor(
    keys: Keys,
    private readonly stage: Stage,
    private readonly world: World,
    private readonly marker: HeldMarker,
    private readonly gravity: Gravity,
    private readonly say: (words: string) => void,
  ) {
    const { canvas } = stage;
    canvas.addEventListener('pointerdown', (event) => this.begin(event), { capture: true });
    canvas.addEventListener('pointermove', (event) => this.move(event));
    for (const type of ['pointerup', 'pointercancel'] as const) {
      canvas.addEventListener(type, (event) => {
        if (event.pointerId === this.press?.pointer) this.end();
      });
    }
    keys.add({
      keys: Object.keys(kWays),
      sign: '← ↑ ↓ →',
      words: 'tilt gravity with the tool Tilt, if the picture has the focus',
      repeats: true,
      on: canvas,
      act: (key) => this.step(key),
      isEnabled: () => this.isActive,
    });
    keys.add({
      keys: ['escape', 'enter'],
      act: () => this.end(),
      isEnabled: () => this.before !== undefined,
    });
  }

  set active(active: boolean) {
    if (!active) this.end();
    this.isActive = active;
  }

  private begin(event: PointerEvent): void {
    if (!this.isActive || this.press || !event.isPrimary || event.button !== 0) return;
    this.stage.turnable = false;
    this.stage.canvas.setPointerCapture(event.pointerId);
    this.press = { pointer: event.pointerId, x: event.clientX, y: event.clientY };
    this.hold();
  }

  private move(event: PointerEvent): void {
    if (!this.press || event.pointerId !== this.press.pointer) return;
    const { width, height } = this.stage.canvas.getBoundingClientRect();
    const scale = (2 * kMostTilt) / Math.min(width, height);
    const right = scale * (event.clientX - this.press.x);
    this.lean(right, scale * (this.press.y - event.clientY));
  }

  private step(key: string): void {
    const [right, away] = kWays[key]!;
    this.hold();
    this.byKeys.right += kStep * right;
    this.byKeys.away += kStep * away;
    this.lean(this.byKeys.right, this.byKeys.away);
  }

  private hold(): void {
    if (this.before) return;
    this.before = { ...this.gravity.present };
    this.byKeys = { right: 0, away: 0 };
    if (this.before.strength === 0) this.say('This scene has no gravity, so a tilt has no effect.');
  }

  private lean(right: number, away: number): void {
    this.gravity.lean(leanInView(right, away, this.stage.viewDirection()), this.before);
    const { height, extent } = this.world;
    const middle = extent.getCenter(new Vector3());
    const way = new Vector3(...gravityOf({ ...this.gravity.present, strength: kArrow * height }));
    this.marker.show(middle, way.add(middle), kEnd * height);
    this.stage.canvas.dataset.tilt = `${this.gravity.present.x} ${this.gravity.present.y}`;
    this.stage.invalidate();
  }

  /** Restores the gravity before the tilt. */
  private end(): void {
    if (this.press) this.stage.turnable = true;
    this.press = undefined;
    if (!this.before) return;
    this.gravity.change(this.before);
    this.before = undefined;
    this.marker.hide();
    delete this.stage.canvas.dataset.tilt;
    this.stage.invalidate();
  }
}
