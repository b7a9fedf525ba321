import { Plane, Vector3 } from 'three';
import type { Vector } from '../../client/index';
import { element } from '../panel/elements';
import type { Stage } from '../view/stage';
import type { World } from '../view/world';
import { Labels } from './labels';
import { personColour } from '../stream/people';
import type { People } from '../stream/people';

/** The interval of pointer messages [ms]. The server forwards ten per second. */
const kPeriodMs = 100;

/** Displays the pointers of others, and sends the user's. */
export class Cursors {
  private readonly labels: Labels;
  private last: Vector | undefined;
  private timer: number | undefined;

  constructor(
    private readonly people: People,
    private readonly stage: Stage,
    private readonly world: World,
    private readonly point: (position: Vector | undefined) => void,
  ) {
    this.labels = new Labels(element('cursors', HTMLElement), stage);
    people.subscribe(() => this.update());
    stage.canvas.addEventListener('pointermove', (event) => this.aim(event));
    stage.canvas.addEventListener('pointerleave', () => this.send(undefined));
  }

  /** Moves the names to their present positions in the picture. */
  update(): void {
    const labels = this.people.others.flatMap(({ participant: key, pointer, name: text, away }) =>
      pointer && !away
        ? [{ key, text, colour: personColour(key), position: pointer.position }]
        : [],
    );
    this.labels.show(labels);
  }

  private aim({ clientX, clientY }: PointerEvent): void {
    if (this.people.others.length === 0 || this.timer !== undefined) return;
    this.timer = window.setTimeout(() => (this.timer = undefined), kPeriodMs);
    const ray = this.stage.rayThrough(clientX, clientY);
    const place =
      this.world.pick(ray)?.position ?? ray.intersectPlane(this.middle(), new Vector3());
    if (place) this.send([place.x, place.y, place.z]);
  }

  /** Returns the plane through the scene's centre, for pointers at no particle. */
  private middle(): Plane {
    const middle = this.world.bounds.getCenter(new Vector3());
    return new Plane().setFromNormalAndCoplanarPoint(this.stage.viewDirection(), middle);
  }

  private send(position: Vector | undefined): void {
    if (!position && !this.last) return;
    this.last = position;
    this.point(position);
  }
}
