import type {
  BodyKindName,
  MaterialDescription,
  SceneEntry,
  SessionDescription,
} from '../../client/index';
import { element, make } from './elements';
import { formatCount } from './format';
import { lookOf } from '../view/base/appearance';
import type { Gallery } from './gallery';

const kKindWords: Readonly<Record<BodyKindName, string>> = {
  liquid: 'liquid',
  deformable: 'deformable',
  rigid: 'rigid',
};

/** The scene picker, the scene's description, and the legend of its colours. */
export class Scenes {
  private readonly picker = element('scene', HTMLSelectElement);
  private readonly text = element('scene-text', HTMLElement);
  private readonly legend = element('legend', HTMLElement);
  private readonly stranger = new Option('', '');
  private entries: SceneEntry[] = [];
  private current: SessionDescription | undefined;

  constructor(
    private readonly gallery: Gallery,
    load: (scene: string) => void,
  ) {
    this.stranger.disabled = true;
    let byKeyboard = false;
    this.picker.addEventListener('keydown', () => (byKeyboard = true));
    this.picker.addEventListener('pointerdown', () => (byKeyboard = false));
    this.picker.addEventListener('change', () => {
      load(this.picker.value);
      if (!byKeyboard) this.picker.blur(); // returns the keys to the page
    });
  }

  enable(enabled: boolean): void {
    this.picker.disabled = !enabled;
    this.gallery.enable(enabled);
  }

  /** Shows the session's scene, also after a rejected choice. */
  refresh(): void {
    if (this.current) this.describe(this.current);
  }

  list(entries: SceneEntry[]): void {
    this.entries = entries;
    this.gallery.list(entries);
    this.picker.replaceChildren(...entries.map(({ name, title }) => new Option(title, name)));
    this.refresh();
  }

  describe(description: SessionDescription): void {
    this.current = description;
    this.gallery.mark(description.scene);
    const entry = this.entries.find(({ name }) => name === description.scene);
    const title = description.title || description.scene;
    this.showStranger(entry ? undefined : title);
    this.picker.value = entry?.name ?? '';
    document.title = `${title} – vat`;
    this.text.textContent = entry?.description ?? 'A scene that is not in the catalogue.';
    this.explainColours(description);
  }

  /** Adds a scene outside the catalogue to the picker as a disabled entry. */
  private showStranger(title: string | undefined): void {
    this.stranger.textContent = title ?? '';
    if (title === undefined) this.stranger.remove();
    else this.picker.prepend(this.stranger);
  }

  private explainColours({ bodies, materials }: SessionDescription): void {
    const kinds = [...new Set(bodies.map(({ kind }) => kind))];
    const items = kinds.map((kind) => {
      const ofKind = bodies.filter((body) => body.kind === kind);
      const count = ofKind.reduce((sum, { particles }) => sum + particles, 0);
      const words = `${kKindWords[kind]} ${formatCount(count)}`;
      const used = materials.filter(({ name }) => ofKind.some(({ material }) => material === name));
      return make('li', {}, ...swatches(used), words);
    });
    this.legend.replaceChildren(...items);
  }
}

/** Returns a dot for each colour of the materials. */
function swatches(materials: readonly MaterialDescription[]): HTMLElement[] {
  const colours = materials.map(({ appearance }) => `#${lookOf(appearance).colour.getHexString()}`);
  return [...new Set(colours)].map((colour) => {
    const dot = make('i');
    dot.style.background = colour;
    return dot;
  });
}
