import { Plane, Vector3 } from 'three';
import type { SessionDescription, Vector } from '../../client/index';
import type { HeldMarker } from '../view/held_marker';
import type { Stage } from '../view/stage';
import type { Picked, World } from '../view/world';
import type { Holding, HoldingMaker } from './holding';

interface Grip {
  held: Holding;
  /** The pointer's id; undefined: the keyboard. */
  pointer: number | undefined;
  body: number;
  particle: number;
  /** The plane through the particle at the start of the grab, parallel to the picture. */
  plane: Plane;
  target: Vector3;
  /** Position and time of the press [px, ms]. */
  pressed: { x: number; y: number; at: number };
}

/** A shorter press without motion is a click [ms, px]. */
const kClickMs = 350;
const kClickPixels = 5;

/** Drags bodies with the pointer: a press on a particle holds it, elsewhere it rotates the view. */
export class Grabber {
  private grip: Grip | undefined;
  private enabled = false;
  /** Whether the pointer has another use. */
  isPaused = false;

  /** `make` begins the effect of a drag. */
  constructor(
    private readonly stage: Stage,
    private readonly world: World,
    private readonly marker: HeldMarker,
    private readonly make: HoldingMaker,
    private readonly refused: (error: unknown) => void,
    private readonly clicked: (body: number, particle: number) => void,
  ) {
    const { canvas } = stage;
    // The capture phase precedes the camera's controls, so that a grab can consume the press.
    canvas.addEventListener('pointerdown', (event) => this.press(event), { capture: true });
    canvas.addEventListener('pointermove', (event) => this.move(event));
    for (const type of ['pointerup', 'pointercancel'] as const) {
      canvas.addEventListener(type, (event) => this.lift(event));
    }
  }

  /** Enables grabbing. Disabling releases the held body. */
  enable(enabled: boolean): void {
    this.enabled = enabled;
    if (!enabled) this.release();
  }

  /** Ends the grab if the session has ended it: it began `anew`, or the body was removed. */
  describe({ bodies }: SessionDescription, anew: boolean): void {
    const { grip } = this;
    if (grip && (anew || !bodies.some(({ body }) => body === grip.body))) this.release();
  }

  /** Ends the grab. `isDone`: the user has completed the drag; otherwise it is cancelled. */
  release(isDone = false): void {
    this.grip?.held.end(isDone);
    this.forget();
  }

  /** Moves the marker to the held particle. */
  update(): void {
    if (!this.grip) return;
    const { body, particle, target } = this.grip;
    const held = this.world.particle(body, particle);
    if (!held) return; // absent from the frame, or not drawn yet
    this.marker.show(held.position, target, held.radius);
  }

  private press(event: PointerEvent): void {
    if (!this.enabled || this.isPaused || this.grip || !event.isPrimary || event.button !== 0)
      return;
    const picked = this.world.pick(this.stage.rayThrough(event.clientX, event.clientY));
    if (!picked) return;
    this.stage.turnable = false;
    this.stage.canvas.setPointerCapture(event.pointerId);
    const pressed = { x: event.clientX, y: event.clientY, at: event.timeStamp };
    this.hold(picked, event.pointerId, pressed);
  }

  /** Grabs a particle at its position; `shift` moves its target. */
  take(picked: Picked): void {
    if (this.enabled && !this.isPaused && !this.grip)
      this.hold(picked, undefined, { x: 0, y: 0, at: -Infinity });
  }

  /** Whether a grab by `take` is active. */
  get isByHand(): boolean {
    return this.grip !== undefined && this.grip.pointer === undefined;
  }

  /** Moves the target of the grab [m]. */
  shift(by: Vector3): void {
    if (this.grip) this.pull(this.grip.target.clone().add(by));
  }

  private hold(picked: Picked, pointer: number | undefined, pressed: Grip['pressed']): void {
    const { body, particle, position } = picked;
    const start = { body, particle, target: toVector(position) };
    this.grip = {
      held: this.make(start, (error) => this.fail(error)),
      pointer,
      body,
      particle,
      plane: new Plane().setFromNormalAndCoplanarPoint(this.stage.viewDirection(), position),
      target: position,
      pressed,
    };
    this.report();
  }

  private pull(target: Vector3): void {
    if (!this.grip) return;
    this.grip.target = target;
    this.grip.held.move(toVector(target));
    this.report();
  }

  private move(event: PointerEvent): void {
    if (!this.grip) return this.hover(event);
    if (event.pointerId !== this.grip.pointer) return;
    const ray = this.stage.rayThrough(event.clientX, event.clientY);
    const target = ray.intersectPlane(this.grip.plane, new Vector3());
    if (target) this.pull(target);
  }

  private lift(event: PointerEvent): void {
    const { grip } = this;
    if (!grip || grip.pointer !== event.pointerId) return;
    this.release(event.type === 'pointerup');
    const { x, y, at } = grip.pressed;
    const isNear = Math.hypot(event.clientX - x, event.clientY - y) < kClickPixels;
    if (isNear && event.timeStamp - at < kClickMs) this.clicked(grip.body, grip.particle);
  }

  private hover({ clientX, clientY, buttons, pointerType }: PointerEvent): void {
    const isFree = this.enabled && !this.isPaused && buttons === 0 && pointerType === 'mouse';
    const { canvas } = this.stage;
    const isOver = isFree && this.world.pick(this.stage.rayThrough(clientX, clientY)) !== undefined;
    canvas.dataset.pointer = isOver ? 'particle' : 'free';
  }

  private fail(error: unknown): void {
    this.forget();
    this.refused(error);
  }

  private forget(): void {
    this.grip = undefined;
    this.stage.turnable = true;
    this.marker.hide();
    this.report();
  }

  /** Writes the held body and the target to the canvas's data attributes. */
  private report(): void {
    const { dataset } = this.stage.canvas;
    delete dataset.heldBody;
    delete dataset.heldParticle;
    delete dataset.heldTarget;
    dataset.pointer = this.grip ? 'holding' : 'free';
    if (this.grip) {
      dataset.heldBody = String(this.grip.body);
      dataset.heldParticle = String(this.grip.particle);
      dataset.heldTarget = toVector(this.grip.target).join(' ');
    }
    this.stage.invalidate();
  }
}

function toVector({ x, y, z }: Vector3): Vector {
  return [x, y, z];
}
