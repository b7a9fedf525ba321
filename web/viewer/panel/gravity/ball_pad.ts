import { element } from '../elements';

const kHalf = 37; // the pad's radius minus the ball's [px]

/** A position in the unit disc: right, up. */
export type Place = readonly [number, number];

/** A round pad with a ball that is dragged. */
export class BallPad {
  readonly area: HTMLElement;
  private readonly ball: HTMLElement;
  private dragging = false;

  /** `id` is the pad's element; the ball's has the suffix "-ball". */
  constructor(
    id: string,
    private readonly isEnabled: () => boolean,
    private readonly move: (at: Place) => void,
    end: () => void = () => undefined,
  ) {
    this.area = element(id, HTMLElement);
    this.ball = element(`${id}-ball`, HTMLElement);
    this.area.addEventListener('pointerdown', (event) => this.drag(event, true));
    this.area.addEventListener('pointermove', (event) => this.drag(event, false));
    for (const type of ['pointerup', 'pointercancel'] as const) {
      this.area.addEventListener(type, () => {
        this.dragging = false;
        end();
      });
    }
  }

  get isDragging(): boolean {
    return this.dragging;
  }

  show([across, up]: Place): void {
    this.ball.style.translate = `${kHalf * across}px ${-kHalf * up}px`;
  }

  private drag(event: PointerEvent, begins: boolean): void {
    if (!this.isEnabled() || (!begins && !this.dragging)) return;
    if (begins) this.area.setPointerCapture(event.pointerId);
    this.dragging = true;
    const { left, top, width, height } = this.area.getBoundingClientRect();
    const across = (2 * (event.clientX - left)) / width - 1;
    const up = 1 - (2 * (event.clientY - top)) / height;
    const far = Math.max(Math.hypot(across, up), 1);
    this.move([across / far, up / far]);
  }
}
