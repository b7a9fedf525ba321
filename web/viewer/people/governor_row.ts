import type { Params } from '../../client/index';
import { element } from '../panel/elements';
import { ask } from '../panel/desk';
import type { Desk } from '../panel/desk';
import type { People } from '../stream/people';

type Points = NonNullable<Params<'session.configure'>['governor']>;

/**
 * Reads the points that `vat tune --front` has written, or returns the reason why they are invalid.
 * The server checks the rest.
 */
export function readPoints(text: string, file: string): { points: Points } | { fault: string } {
  let value: unknown;
  try {
    value = JSON.parse(text);
  } catch {
    return { fault: `“${file}” is not JSON. Choose a file of vat tune --front.` };
  }
  const points = (value as { governor?: unknown } | null)?.governor;
  if (!Array.isArray(points) || points.length === 0)
    return { fault: `“${file}” has no points of the governor. Choose a file of vat tune --front.` };
  return { points: points as Points };
}

/** The owner's permission to reduce the accuracy of a session that is too slow. */
export class GovernorRow {
  private readonly row = element('governor-row', HTMLElement);
  private readonly box = element('governor', HTMLInputElement);
  private readonly input = element('governor-file', HTMLInputElement);

  constructor(
    private readonly people: People,
    private readonly desk: Desk,
  ) {
    people.subscribe(() => this.show());
    this.box.addEventListener('change', () => {
      if (this.box.checked) this.input.click();
      else void this.permit([]);
      this.show(); // the server's reply changes the box
    });
    this.input.addEventListener('change', () => {
      void this.take(this.input.files?.[0]);
      this.input.value = ''; // allows the same file to be chosen again
    });
  }

  private show(): void {
    this.row.hidden = !this.people.isOwner;
    this.box.checked = this.people.settings?.governor !== undefined;
  }

  private async take(file: File | undefined): Promise<void> {
    if (!file) return;
    const read = readPoints(await file.text(), file.name);
    if ('fault' in read) this.desk.fail(read.fault);
    else await this.permit(read.points);
  }

  private async permit(governor: Points): Promise<void> {
    await ask(this.desk, 'session.configure', { governor });
  }
}
