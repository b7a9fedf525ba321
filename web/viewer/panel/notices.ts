import type { GuardEvent, SessionDescription } from '../../client/index';
import { element, make, makeButton } from './elements';
import { formatSeconds } from './format';

const kMostShown = 4;

type Level = 'warning' | 'error';

export interface Notice {
  level: Level;
  text: string;
}

/** The action of a button in a message. */
export interface Remedy {
  label: string;
  act(): void;
}

const kWarningMs = 15_000;
/** The display time of messages with an action [ms]. */
const kOfferMs = 60_000;

/** Messages over the scene, the newest first, with a maximum number. Errors remain until dismissed. */
export class Notices {
  private readonly list = element('notices', HTMLOListElement);

  add(level: Level, text: string, remedy?: Remedy): void {
    const newest = this.list.firstElementChild;
    if (newest?.firstChild?.textContent === text) return; // already displayed
    const item = make('li', {}, make('span', {}, text));
    item.dataset.level = level;
    if (remedy) {
      const { label, act } = remedy;
      item.append(
        makeButton(label, () => {
          item.remove();
          act();
        }),
      );
    }
    item.append(makeButton('×', () => item.remove(), 'Dismiss'));
    this.list.prepend(item);
    while (this.list.children.length > kMostShown) this.list.lastElementChild?.remove();
    if (level === 'warning') window.setTimeout(() => item.remove(), remedy ? kOfferMs : kWarningMs);
  }
}

const kCauses: Readonly<Record<GuardEvent['cause'], string>> = {
  non_finite: 'has a position or velocity that is not a number',
  outside_domain: 'left the domain',
  too_fast: 'moved too fast',
  too_many_pairs: 'had too many neighbours',
};

/** Returns an event of the simulation's guard as text. */
export function describeGuard(guard: GuardEvent, description?: SessionDescription): string {
  const body = description?.bodies.find((candidate) => candidate.body === guard.body);
  const name = body ? `“${body.name}”` : `body ${guard.body}`;
  const what = `At ${formatSeconds(guard.time)} particle ${guard.particle} of ${name} ${kCauses[guard.cause]}`;
  return guard.recovered
    ? `${what}. The step was repeated in smaller parts.`
    : `${what}. The session has paused at the last valid state. Reset it to continue.`;
}
