import { MathUtils, Plane, Vector3 } from 'three';
import type { Stage } from '../view/stage';
import type { World } from '../view/world';
import { Ghost } from './ghost';
import type { Thing } from './ghost';

/** A press that moves further rotates the view [px]. */
const kStill = 6;

/** Lets the user choose a position: the object follows the pointer until it is placed. */
export class Placer {
  private readonly ghost = new Ghost();
  private thing: Thing | undefined;
  private place: Vector3 | undefined;
  private pressed: { x: number; y: number } | undefined;
  private put: (place: Vector3) => void = () => undefined;

  /** `ended` is called at the end of placing, `full` if the position is not free. */
  constructor(
    private readonly stage: Stage,
    private readonly world: World,
    private readonly ended: () => void,
    private readonly full: () => void,
  ) {
    stage.scene.add(this.ghost.group);
    const { canvas } = stage;
    canvas.addEventListener('pointermove', (event) => this.move(event));
    canvas.addEventListener('pointerdown', (event) => this.press(event), { capture: true });
    canvas.addEventListener('pointerup', (event) => this.lift(event));
  }

  get isPlacing(): boolean {
    return this.thing !== undefined;
  }

  /** Begins at the centre of the scene, from where keys can also place the object. */
  begin(thing: Thing, put: (place: Vector3) => void): void {
    this.thing = thing;
    this.put = put;
    this.ghost.show(thing);
    const box = this.world.extent;
    const start = box.getCenter(new Vector3());
    start.z = box.max.z - thing.footprint.box.max.z;
    this.moveTo(start);
    this.stage.canvas.dataset.placing = 'true';
  }

  end(): void {
    if (!this.thing) return;
    this.thing = undefined;
    this.ghost.hide();
    delete this.stage.canvas.dataset.placing;
    this.stage.invalidate();
    this.ended();
  }

  /** Places the object if its position is free. */
  confirm(): void {
    const { thing, place } = this;
    if (!thing || !place) return;
    if (!this.isFree(place)) return this.full();
    this.put(place.clone());
    this.end();
  }

  /** Moves the object [m]. */
  shift(by: Vector3): void {
    if (this.place) this.moveTo(this.place.clone().add(by));
  }

  private press(event: PointerEvent): void {
    if (!this.thing || event.button !== 0 || !event.isPrimary) return;
    this.pressed = { x: event.clientX, y: event.clientY };
    // A finger drags the object and places it when lifted. A dragging mouse rotates the view.
    if (event.pointerType !== 'mouse') this.stage.turnable = false;
    this.move(event);
  }

  private lift(event: PointerEvent): void {
    const { pressed } = this;
    this.pressed = undefined;
    this.stage.turnable = true;
    if (!this.thing || !pressed) return;
    if (event.pointerType !== 'mouse') return this.confirm();
    const far = Math.hypot(event.clientX - pressed.x, event.clientY - pressed.y);
    if (far < kStill) this.confirm();
  }

  private move({ clientX, clientY }: PointerEvent): void {
    if (!this.thing) return;
    const ray = this.stage.rayThrough(clientX, clientY);
    const middle = this.world.extent.getCenter(new Vector3());
    const upright = this.stage.viewDirection().setZ(0).normalize();
    const plane = new Plane().setFromNormalAndCoplanarPoint(upright, middle);
    const place = ray.intersectPlane(plane, new Vector3());
    if (place) this.moveTo(place);
  }

  /** Moves the object to the nearest position inside the scene. */
  private moveTo(place: Vector3): void {
    const { min, max } = this.world.extent;
    const { box } = this.thing!.footprint;
    for (const axis of ['x', 'y', 'z'] as const) {
      const [low, high] = [min[axis] - box.min[axis], max[axis] - box.max[axis]];
      if (low <= high) place[axis] = MathUtils.clamp(place[axis], low, high);
    }
    this.place = place;
    this.ghost.moveTo(this.place, this.isFree(this.place));
    this.stage.invalidate();
  }

  private isFree(place: Vector3): boolean {
    const { footprint, body } = this.thing!;
    return this.world.isFree(place, footprint, body);
  }
}
