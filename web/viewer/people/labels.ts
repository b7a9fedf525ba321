import { Vector3 } from 'three';
import type { Vector } from '../../client/index';
import { make } from '../panel/elements';
import type { Stage } from '../view/stage';

/** A name at a position in the scene. */
export interface Label {
  key: number;
  text: string;
  colour: string;
  position: Vector;
}

/** Names over the picture, at the projections of their positions. */
export class Labels {
  private readonly shown = new Map<number, HTMLElement>();

  /** `className` is the CSS class of each label. */
  constructor(
    private readonly layer: HTMLElement,
    private readonly stage: Stage,
    private readonly className = '',
  ) {}

  /** Replaces the labels. */
  show(labels: Iterable<Label>): void {
    const present = new Set<number>();
    for (const label of labels) {
      present.add(label.key);
      this.place(this.elementOf(label), label);
    }
    for (const [key, element] of this.shown) {
      if (present.has(key)) continue;
      element.remove();
      this.shown.delete(key);
    }
  }

  private elementOf({ key, colour }: Label): HTMLElement {
    const known = this.shown.get(key);
    if (known) return known;
    const element = make('span', { className: this.className });
    element.style.background = colour;
    this.shown.set(key, element);
    this.layer.append(element);
    return element;
  }

  private place(element: HTMLElement, { text, position }: Label): void {
    const { clientWidth, clientHeight } = this.layer;
    const seen = new Vector3(...position).project(this.stage.camera);
    element.hidden = Math.abs(seen.z) > 1;
    const x = (clientWidth * (seen.x + 1)) / 2;
    const y = (clientHeight * (1 - seen.y)) / 2;
    element.style.translate = `${x.toFixed(1)}px ${y.toFixed(1)}px`;
    if (element.textContent !== text) element.textContent = text;
  }
}
