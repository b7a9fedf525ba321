import type { SceneEntry } from '../../client/index';
import { element, make, onPress } from './elements';

/** The addresses of the scenes' pictures, made by scripts/gallery.ts. */
const kPictures = import.meta.glob<string>('../scenes/*.webp', {
  eager: true,
  query: '?url',
  import: 'default',
});

/** The dialog of scenes with pictures. */
export class Gallery {
  private readonly dialog = element('gallery', HTMLDialogElement);
  private readonly items = element('gallery-list', HTMLElement);
  private readonly opener = element('gallery-open', HTMLButtonElement);
  private current = '';

  constructor(private readonly load: (scene: string) => void) {
    onPress(this.opener, () => this.open());
  }

  open(): void {
    if (this.opener.disabled) return;
    this.dialog.showModal();
    this.items.querySelector<HTMLElement>('[aria-current="true"]')?.focus();
  }

  enable(enabled: boolean): void {
    this.opener.disabled = !enabled;
    if (!enabled) this.dialog.close();
  }

  list(entries: SceneEntry[]): void {
    this.items.replaceChildren(...entries.map((entry) => this.card(entry)));
    this.mark(this.current);
  }

  /** Marks the current scene. */
  mark(scene: string): void {
    this.current = scene;
    for (const button of this.items.querySelectorAll('button')) {
      button.ariaCurrent = String(button.dataset.scene === scene);
    }
  }

  private card({ name, title, description }: SceneEntry): HTMLElement {
    const src = kPictures[`../scenes/${name}.webp`];
    const picture = make('img', { loading: 'lazy', alt: '', hidden: src === undefined });
    if (src !== undefined) picture.src = src;
    const words = make('span', {}, title);
    const button = make('button', { type: 'button', title: description }, picture, words);
    button.dataset.scene = name;
    button.addEventListener('click', () => {
      this.dialog.close();
      this.load(name);
    });
    return make('li', {}, button);
  }
}
