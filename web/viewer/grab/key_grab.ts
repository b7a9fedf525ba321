import { Vector3 } from 'three';
import type { Keys } from '../panel/keys';
import type { Stage } from '../view/stage';
import type { World } from '../view/world';
import type { Grabber } from './grabber';

/** The displacement by a key, relative to the height of the scene. */
const kStep = 0.03;

type Way = 'right' | 'up' | 'away';

const kWays: Readonly<Record<string, readonly [Way, number]>> = {
  arrowleft: ['right', -1],
  arrowright: ['right', 1],
  arrowup: ['up', 1],
  arrowdown: ['up', -1],
  pageup: ['away', 1],
  pagedown: ['away', -1],
};

/** Drags bodies by keys: a key holds the next body, arrows move the target. */
export class KeyGrab {
  private body: number | undefined;

  /** `bodies` returns ids. `say` announces the held body to screen readers. */
  constructor(
    keys: Keys,
    private readonly grabber: Grabber,
    private readonly stage: Stage,
    private readonly world: World,
    private readonly bodies: () => number[],
    private readonly say: (body: number | undefined) => void,
  ) {
    const isHeld = (): boolean => grabber.isByHand;
    keys.add({
      keys: ['b'],
      sign: 'B',
      words: 'hold the next body; the arrows and page keys then pull or aim',
      act: () => this.next(),
    });
    keys.add({
      keys: Object.keys(kWays),
      repeats: true,
      act: (key) => this.pull(key),
      isEnabled: isHeld,
    });
    keys.add({
      keys: ['enter'],
      sign: 'Enter',
      words: 'release the body; the tool Push then pushes it',
      act: () => this.letGo(true),
      isEnabled: isHeld,
    });
    keys.add({
      keys: ['escape'],
      sign: 'Esc',
      words: 'release the body without a push',
      act: () => this.letGo(false),
      isEnabled: isHeld,
    });
  }

  private next(): void {
    this.grabber.release();
    const all = this.bodies();
    const place = this.body === undefined ? 0 : all.indexOf(this.body) + 1;
    for (const body of [...all.slice(place), ...all.slice(0, place)]) {
      const middle = this.world.middleOf(body);
      if (!middle) continue;
      this.body = body;
      this.grabber.take({ body, ...middle });
      return this.say(this.grabber.isByHand ? body : undefined);
    }
  }

  private pull(key: string): void {
    const [way, sign] = kWays[key]!;
    const away = this.stage.viewDirection().setZ(0).normalize();
    const directions: Record<Way, Vector3> = {
      right: new Vector3(away.y, -away.x, 0),
      up: new Vector3(0, 0, 1),
      away,
    };
    this.grabber.shift(directions[way].multiplyScalar(sign * kStep * this.world.height));
  }

  private letGo(isDone: boolean): void {
    this.grabber.release(isDone);
    this.say(undefined);
  }
}
