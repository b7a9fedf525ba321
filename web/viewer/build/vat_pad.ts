import type { SessionDescription, Vector } from '../../client/index';
import { element } from '../panel/elements';
import { ask } from '../stream/desk';
import type { Desk } from '../stream/desk';
import { Newest } from '../stream/newest';

/** Of the vat's longest side: how far it goes at the pad's edge. */
const kReach = 0.4;

/** Of that reach: how far an arrow key shifts. */
const kStep = 0.2;

const kArrows: Readonly<Record<string, readonly [number, number]>> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};

/** Slides the vat by hand: it follows a small ball, and goes back to its own motion once let go. */
export class VatPad {
  private readonly row = element('slide-row', HTMLElement);
  private readonly pad = element('slide', HTMLElement);
  private readonly ball = element('slide-ball', HTMLElement);
  private readonly newest: Newest<Vector>;
  private longest = 0;
  /** From -1 to 1 along x and y. */
  private at: readonly [number, number] = [0, 0];
  private isEnabled = false;
  private isDragging = false;

  constructor(desk: Desk) {
    this.newest = new Newest((offset: Vector) => ask(desk, 'world.move_vat', { offset }));
    this.pad.addEventListener('pointerdown', (event) => this.drag(event, true));
    this.pad.addEventListener('pointermove', (event) => this.drag(event, false));
    for (const type of ['pointerup', 'pointercancel'] as const) {
      this.pad.addEventListener(type, () => this.letGo());
    }
    this.pad.addEventListener('keydown', (event) => this.press(event));
    this.pad.addEventListener('blur', () => this.letGo());
  }

  enable(enabled: boolean): void {
    this.isEnabled = enabled;
    this.pad.tabIndex = enabled ? 0 : -1;
  }

  describe({ vat }: SessionDescription): void {
    this.row.hidden = vat === null;
    this.longest = vat ? Math.max(...vat.max.map((most, axis) => most - vat.min[axis]!)) : 0;
  }

  private drag(event: PointerEvent, begins: boolean): void {
    if (!this.isEnabled || (!begins && !this.isDragging)) return;
    if (begins) this.pad.setPointerCapture(event.pointerId);
    this.isDragging = true;
    const { left, top, width, height } = this.pad.getBoundingClientRect();
    const across = (2 * (event.clientX - left)) / width - 1;
    const up = 1 - (2 * (event.clientY - top)) / height;
    const far = Math.max(Math.hypot(across, up), 1);
    this.move([across / far, up / far]);
  }

  private press(event: KeyboardEvent): void {
    const way = kArrows[event.key];
    if (!this.isEnabled || !way) return;
    event.preventDefault();
    event.stopPropagation();
    const within = (value: number): number => Math.min(Math.max(value, -1), 1);
    this.move([within(this.at[0] + kStep * way[0]), within(this.at[1] + kStep * way[1])]);
  }

  private letGo(): void {
    this.isDragging = false;
    if (this.at[0] !== 0 || this.at[1] !== 0) this.move([0, 0]);
  }

  private move(at: readonly [number, number]): void {
    this.at = at;
    const half = 37; // the pad's radius without the ball's [px]
    this.ball.style.translate = `${half * at[0]}px ${-half * at[1]}px`;
    const reach = kReach * this.longest;
    this.newest.put([reach * at[0], reach * at[1], 0]);
  }
}
