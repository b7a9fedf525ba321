import { mapStops } from '../view/colour/maps';
import { formatQuantity, kQuantities } from '../view/colour/quantity';
import { make } from './elements';
import type { ColourScale, Meaning } from '../view/colour/colour_scale';

const kTicks = 5;

/** The update interval of the numbers [ms], for readability. */
const kPeriodMs = 250;

/** The legend of colours next to the picture. */
export class ColourLegend {
  readonly element: HTMLElement;
  private readonly title = make('figcaption');
  private readonly bar = make('div', { className: 'bar' });
  private readonly ticks = make('ol');
  /** The next meaning to display. */
  private meaning: Meaning | undefined;
  private writtenAt = -Infinity;

  constructor(scale: ColourScale) {
    const properties = { id: 'colour-legend', hidden: true };
    this.element = make('figure', properties, this.title, this.bar, this.ticks);
    scale.subscribe((meaning) => this.show(meaning));
  }

  private show(meaning: Meaning | undefined): void {
    this.element.hidden = meaning === undefined;
    const isPending = this.meaning !== undefined;
    this.meaning = meaning;
    if (!meaning || isPending) return;
    const wait = Math.max(this.writtenAt + kPeriodMs - performance.now(), 0);
    window.setTimeout(() => this.write(), wait);
  }

  private write(): void {
    const { meaning } = this;
    this.meaning = undefined;
    if (!meaning) return;
    const { quantity, map, range } = meaning;
    const { title, unit } = kQuantities[quantity];
    this.writtenAt = performance.now();
    this.title.textContent = `${title} [${unit}]`;
    this.bar.style.background = `linear-gradient(to top, ${mapStops(map).join(', ')})`;
    const items = Array.from({ length: kTicks }, (_, i) =>
      make('li', {}, formatQuantity(range.max - (i / (kTicks - 1)) * (range.max - range.min))),
    );
    this.ticks.replaceChildren(...items);
    this.element.dataset.min = String(range.min);
    this.element.dataset.max = String(range.max);
  }
}
