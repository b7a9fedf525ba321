import type { Result } from '../../client/index';
import { element, make } from '../panel/elements';
import type { Desk } from '../panel/desk';
import { formatQuantity } from '../view/colour/quantity';
import type { ViewSettings } from '../view/base/settings';
import type { View } from '../view/view';
import { LinkLines } from './link_lines';

/** The interval of requests while springs or contacts are shown [ms]. */
const kPeriodMs = 200;

/** The maximum number of lines; more would hide one another. */
const kMost = 4000;

/** Displays springs by strain and contacts by force. They are requested while they are shown. */
export class Links {
  private readonly springs: LinkLines;
  private readonly contacts: LinkLines;
  private readonly words = make('p', { id: 'links-words', className: 'view-words', hidden: true });
  private newest: Result<'state.connections'> | undefined;
  private isJoined = false;
  private isBusy = false;
  /** The switches at the last request. */
  private shown = '';

  constructor(
    private readonly desk: Desk,
    private readonly view: View,
  ) {
    this.springs = new LinkLines(view.stage.scene, 1.2);
    this.contacts = new LinkLines(view.stage.scene, 2);
    view.settings.subscribe(() => void this.ask());
    window.setInterval(() => void this.ask(), kPeriodMs);
  }

  /** Inserts its controls into the view's options. */
  mount(): void {
    element('view-options', HTMLElement).append(this.words);
  }

  enable(isJoined: boolean): void {
    this.isJoined = isJoined;
    this.newest = undefined;
  }

  /** Discards the lines, because new bodies can have the ids of removed ones. */
  describe(): void {
    this.newest = undefined;
  }

  /** Moves the lines to the positions of the current frame. */
  follow(): void {
    if (this.newest) this.draw();
  }

  private get settings(): Readonly<ViewSettings> {
    return this.view.settings.settings;
  }

  private async ask(): Promise<void> {
    const { springs, contacts } = this.settings;
    const shown = `${springs} ${contacts}`;
    const isChanged = shown !== this.shown;
    if (!springs && !contacts) {
      this.shown = shown;
      this.newest = undefined;
      if (isChanged) this.draw();
      return;
    }
    if (!this.isJoined || this.isBusy || document.hidden) return;
    this.isBusy = true;
    this.shown = shown;
    try {
      const before = this.newest?.tick;
      this.newest = await this.desk.request('state.connections', { most: kMost });
      // A paused scene is not drawn again.
      if (isChanged || this.newest.tick !== before) this.draw();
    } catch (error) {
      // Switched off, because repeated requests would also be rejected.
      this.view.settings.change({ springs: false, contacts: false });
      this.desk.refuse(error);
    } finally {
      this.isBusy = false;
    }
  }

  private draw(): void {
    const { newest, settings, view } = this;
    const placeOf = (body: number, particle: number) =>
      view.world.particle(body, particle)?.position;
    const strains = settings.springs ? (newest?.springs.strains ?? []) : [];
    const forces = settings.contacts ? (newest?.contacts.forces ?? []) : [];
    const [strain, force] = [greatest(strains), greatest(forces)];
    const shown = [
      this.springs.show({ pairs: newest?.springs.pairs ?? [], values: strains }, placeOf, strain),
      this.contacts.show({ pairs: newest?.contacts.pairs ?? [], values: forces }, placeOf, force),
    ];
    view.stage.canvas.dataset.links = shown.join(' ');
    view.stage.invalidate();
    this.explain(strain, force);
  }

  private explain(strain: number, force: number): void {
    const { settings, newest } = this;
    const springs = newest?.springs.total ?? 0;
    const contacts = newest?.contacts.total ?? 0;
    const parts = [
      ...(settings.springs && newest
        ? [
            springs === 0
              ? 'This scene has no springs.'
              : `Springs: red are stretched, blue are compressed, by up to ${formatQuantity(100 * strain)} %.`,
          ]
        : []),
      ...(settings.contacts && newest
        ? [
            contacts === 0
              ? 'There are no contacts. In most scenes, liquids act on bodies by pressure, without contacts.'
              : `Contacts: red for the largest forces, up to ${formatQuantity(force)} N.`,
          ]
        : []),
    ];
    this.words.hidden = parts.length === 0;
    const text = parts.join(' ');
    if (this.words.textContent !== text) this.words.textContent = text;
  }
}

function greatest(values: readonly number[]): number {
  return values.reduce((most, value) => Math.max(most, Math.abs(value)), 0);
}
