import type { SessionDescription, Vector } from '../../client/index';
import { BallPad } from '../panel/gravity/ball_pad';
import type { Place } from '../panel/gravity/ball_pad';
import { element } from '../panel/elements';
import { ask } from '../panel/desk';
import type { Desk } from '../panel/desk';
import { Newest } from '../stream/newest';

/** The displacement at the pad's edge, relative to the vat's longest side. */
const kReach = 0.4;

/** The displacement by an arrow key, relative to that. */
const kStep = 0.2;

const kArrows: Readonly<Record<string, Place>> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};

/** Slides the vat by a pad. After release, the vat returns to its scripted motion. */
export class VatPad {
  private readonly row = element('slide-row', HTMLElement);
  private readonly pad = new BallPad(
    'slide',
    () => this.isEnabled,
    (at) => this.move(at),
    () => this.letGo(),
  );
  private readonly newest: Newest<Vector>;
  private longest = 0;
  /** Position of the ball, -1 to 1 along x and y. */
  private at: Place = [0, 0];
  private isEnabled = false;

  constructor(desk: Desk) {
    this.newest = new Newest((offset: Vector) => ask(desk, 'world.move_vat', { offset }));
    this.pad.area.addEventListener('keydown', (event) => this.press(event));
    this.pad.area.addEventListener('blur', () => this.letGo());
  }

  enable(enabled: boolean): void {
    this.isEnabled = enabled;
    this.pad.area.tabIndex = enabled ? 0 : -1;
  }

  describe({ vat }: SessionDescription): void {
    this.row.hidden = vat === null;
    this.longest = vat ? Math.max(...vat.max.map((most, axis) => most - vat.min[axis]!)) : 0;
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
    if (this.at[0] !== 0 || this.at[1] !== 0) this.move([0, 0]);
  }

  private move(at: Place): void {
    this.at = at;
    this.pad.show(at);
    const reach = kReach * this.longest;
    this.newest.put([reach * at[0], reach * at[1], 0]);
  }
}
