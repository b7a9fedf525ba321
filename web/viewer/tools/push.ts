import { Vector3 } from 'three';
import type { Vector } from '../../client/index';
import { densityOf, massOf } from '../build/measures';
import type { SceneDocument } from '../build/scene_document';
import type { Holding, Start } from '../grab/holding';
import { ask } from '../panel/desk';
import type { Desk } from '../panel/desk';

/** The duration of a push [s]. */
const kSeconds = 0.1;

/** A drag over the height of the scene gives this multiple of the speed of a fall from there. */
const kFalls = 2;
const kGravity = 9.81;

/** A shorter drag, relative to the height of the scene, is a click. */
const kLeast = 0.01;

/** Returns the change of velocity by a drag in a scene of this height, at most that of its height. */
export function speedOf(drag: Vector3, height: number): Vector3 {
  const share = drag.clone().divideScalar(height).clampLength(0, 1);
  return share.multiplyScalar(kFalls * Math.sqrt(2 * kGravity * height));
}

/** A drag of a body that ends with a push along the drag. */
export class Push implements Holding {
  private target: Vector;

  /** `push` receives the displacement from the particle to the target [m]. */
  constructor(
    private readonly start: Start,
    private readonly push: (body: number, drag: Vector3) => void,
  ) {
    this.target = start.target;
  }

  move(target: Vector): void {
    this.target = target;
  }

  end(isDone: boolean): void {
    const drag = new Vector3(...this.target).sub(new Vector3(...this.start.target));
    if (isDone) this.push(this.start.body, drag);
  }
}

/** Properties of a body in the picture. */
export interface Pushed {
  name: string;
  material: string;
  particles: number;
  /** Radius of a particle [m]. */
  radius: number;
}

/** Sends forces that give a body a velocity. The force is proportional to the mass of the body. */
export class Pusher {
  /** `bodyOf` returns undefined for removed bodies; `height` returns the scene's height [m]. */
  constructor(
    private readonly desk: Desk,
    private readonly document: SceneDocument,
    private readonly bodyOf: (body: number) => Pushed | undefined,
    private readonly height: () => number,
  ) {}

  async push(body: number, drag: Vector3): Promise<void> {
    const height = this.height();
    const pushed = this.bodyOf(body);
    if (!pushed || drag.length() < kLeast * height) return;
    const mass = await this.massOf(pushed);
    const { x, y, z } = speedOf(drag, height).multiplyScalar(mass / kSeconds);
    await ask(this.desk, 'world.apply_force', { body, force: [x, y, z], duration: kSeconds });
  }

  /** Returns the mass [kg], estimated from the particles if the scene does not state it. */
  private async massOf({ name, material, particles, radius }: Pushed): Promise<number> {
    const scene = await this.document.get();
    const body = scene?.bodies.find((candidate) => candidate.name === name);
    const known = scene && body && massOf(scene, body, particles);
    if (known !== undefined) return known;
    const density = densityOf(scene ?? { materials: [] }, material);
    return density * particles * (2 * radius) ** 3;
  }
}
