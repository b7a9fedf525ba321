import { Plane, Vector3 } from 'three';
import type { Vector } from '../../client/index';
import type { Request } from '../stream/stream';
import type { HeldMarker } from '../view/held_marker';
import type { Stage } from '../view/stage';
import type { World } from '../view/world';
import { Held } from './held';

interface Grip {
  held: Held;
  pointer: number;
  body: number;
  particle: number;
  /** Through the particle when it was taken, parallel to the picture. */
  plane: Plane;
  target: Vector3;
}

/** Pulls bodies with the pointer: a press on a particle takes it, elsewhere it turns the view. */
export class Grabber {
  private grip: Grip | undefined;
  private enabled = false;

  constructor(
    private readonly stage: Stage,
    private readonly world: World,
    private readonly marker: HeldMarker,
    private readonly request: Request,
    private readonly refused: (error: unknown) => void,
  ) {
    const { canvas } = stage;
    // In the capture phase: this comes before the camera's controls and can keep a press from them.
    canvas.addEventListener('pointerdown', (event) => this.press(event), { capture: true });
    canvas.addEventListener('pointermove', (event) => this.move(event));
    for (const type of ['pointerup', 'pointercancel'] as const) {
      canvas.addEventListener(type, (event) => this.lift(event));
    }
  }

  /** Without a session there is nothing to take; what is held is let go. */
  enable(enabled: boolean): void {
    this.enabled = enabled;
    if (!enabled) this.release();
  }

  /** Lets go, as when the pointer is lifted. */
  release(): void {
    this.grip?.held.end();
    this.forget();
  }

  /** Puts the marker where the held particle is drawn now. */
  update(): void {
    if (!this.grip) return;
    const { body, particle, target } = this.grip;
    const held = this.world.particle(body, particle);
    if (!held) return this.release(); // its body has gone
    this.marker.show(held.position, target, held.radius);
  }

  private press(event: PointerEvent): void {
    if (!this.enabled || this.grip || !event.isPrimary || event.button !== 0) return;
    const picked = this.world.pick(this.stage.rayThrough(event.clientX, event.clientY));
    if (!picked) return;
    const { body, particle, position } = picked;
    this.stage.turnable = false;
    this.stage.canvas.setPointerCapture(event.pointerId);
    const start = { body, particle, target: toVector(position) };
    this.grip = {
      held: new Held(this.request, start, (error) => this.fail(error)),
      pointer: event.pointerId,
      body,
      particle,
      plane: new Plane().setFromNormalAndCoplanarPoint(this.stage.viewDirection(), position),
      target: position,
    };
    this.report();
  }

  private move(event: PointerEvent): void {
    if (!this.grip) return this.hover(event);
    if (event.pointerId !== this.grip.pointer) return;
    const ray = this.stage.rayThrough(event.clientX, event.clientY);
    const target = ray.intersectPlane(this.grip.plane, new Vector3());
    if (!target) return;
    this.grip.target = target;
    this.grip.held.move(toVector(target));
    this.report();
  }

  private lift(event: PointerEvent): void {
    if (this.grip?.pointer === event.pointerId) this.release();
  }

  private hover({ clientX, clientY, buttons, pointerType }: PointerEvent): void {
    const isFree = this.enabled && buttons === 0 && pointerType === 'mouse';
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

  /** Says on the canvas what is held and where it is pulled to. */
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
