import { Vector3 } from 'three';
import type { Keys } from '../panel/keys';
import type { Stage } from '../view/stage';
import type { World } from '../view/world';
import type { Grabber } from './grabber';

/** Of the height of the scene: how far a key pulls. */
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

/** Takes bodies by keys: one after the other is held, and pulled by the arrows. */
export class KeyGrab {
  private body: number | undefined;

  /** `bodies`: their ids. `say` tells what is held, for who does not see it. */
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
      words: 'hold the next body; the arrows and page keys then pull it',
      act: () => this.next(),
    });
    keys.add({
      keys: Object.keys(kWays),
      repeats: true,
      act: (key) => this.pull(key),
      isEnabled: isHeld,
    });
    keys.add({
      keys: ['escape', 'enter'],
      sign: 'Esc',
      words: 'let it go',
      act: () => this.letGo(),
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

  private letGo(): void {
    this.grabber.release();
    this.say(undefined);
  }
}
