import type { BodyDescription, Scene } from '../../client/index';
import { make, makeButton } from '../panel/elements';
import { materialsFor } from './body_choice';

/** The maximum number of listed bodies. Others can be selected in the picture. */
const kMostListed = 40;

export interface BodyActions {
  remove(body: BodyDescription): void;
  remake(body: BodyDescription, material: string): void;
  move(body: BodyDescription): void;
}

/** The list of the scene's bodies, with the actions for each. */
export class BodyList {
  readonly element = make('ul', { id: 'bodies', className: 'kept', ariaLabel: 'Bodies' });
  private bodies: readonly BodyDescription[] = [];
  private scene: Scene | undefined;
  private isEnabled = false;

  constructor(private readonly actions: BodyActions) {}

  enable(enabled: boolean): void {
    this.isEnabled = enabled;
    for (const control of this.element.querySelectorAll<HTMLButtonElement | HTMLSelectElement>(
      'button, select',
    )) {
      control.disabled = !enabled;
    }
  }

  describe(bodies: readonly BodyDescription[], scene: Scene | undefined): void {
    this.bodies = bodies;
    this.scene = scene;
    const items = bodies.slice(0, kMostListed).map((body) => this.item(body));
    const rest = this.bodies.length - items.length;
    if (rest > 0) items.push(make('li', { className: 'none' }, `and ${rest} more`));
    if (items.length === 0) items.push(make('li', { className: 'none' }, 'No bodies yet.'));
    this.element.replaceChildren(...items);
    this.enable(this.isEnabled);
  }

  private item(body: BodyDescription): HTMLElement {
    const { name, kind } = body;
    const what = make('span', { className: 'what' }, make('b', {}, name));
    const material = this.materialOf(body);
    what.append(material ?? make('small', {}, `${kind} · ${body.material}`));
    const item = make('li', {}, what);
    item.dataset.body = String(body.body);
    item.append(
      makeButton('Move', () => this.actions.move(body), `Move ${name}`),
      makeButton('Delete', () => this.actions.remove(body), `Delete ${name}`),
    );
    return item;
  }

  /** Returns a picker of materials if the body can have more than one. */
  private materialOf(body: BodyDescription): HTMLElement | undefined {
    const { scene } = this;
    const isMade = scene?.bodies.some(({ name }) => name === body.name);
    const others = scene && isMade ? materialsFor(scene, body.kind) : [];
    if (others.length < 2) return undefined;
    const picker = make('select', { ariaLabel: `Material of ${body.name}` });
    for (const { name } of others) picker.add(new Option(name, name));
    picker.value = body.material;
    picker.addEventListener('change', () => this.actions.remake(body, picker.value));
    return picker;
  }
}
