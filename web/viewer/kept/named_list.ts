import { element, make, makeButton } from '../panel/elements';

/** A saved item and its actions. */
export interface KeptEntry {
  name: string;
  /** Author and time. */
  words: string;
  use(): void;
  /** Deletes the item; undefined if it belongs to another user. */
  remove?: () => void;
}

/** The time for the second press on “Delete” [ms]. */
const kArmedMs = 4000;

/** A form that saves an item under a name, and the list of saved items. */
export class NamedList {
  private readonly list: HTMLElement;
  private readonly name: HTMLInputElement;
  private readonly keepButton: HTMLButtonElement;
  private isEnabled = false;

  /** `use`: the text on each item's button; `none`: the text of an empty list. */
  constructor(
    private readonly id: string,
    title: string,
    private readonly words: { use: string; none: string },
    keep: (name: string) => void,
  ) {
    this.name = make('input', {
      id: `${id}-name`,
      maxLength: 48,
      placeholder: 'Name',
      ariaLabel: `New name in “${title}”`,
      disabled: true,
    });
    this.keepButton = make('button', { id: `${id}-keep`, disabled: true }, 'Save');
    const form = make('form', { className: 'row' }, this.name, this.keepButton);
    form.addEventListener('submit', (event) => {
      event.preventDefault();
      const name = this.name.value.trim();
      if (name === '') this.name.focus();
      else keep(name);
    });
    this.list = make('ul', { id, className: 'kept', ariaLabel: title });
    element('kept-place', HTMLElement).append(make('h3', {}, title), form, this.list);
    this.show([]);
  }

  enable(enabled: boolean): void {
    this.isEnabled = enabled;
    this.name.disabled = this.keepButton.disabled = !enabled;
    for (const button of this.list.querySelectorAll('button')) button.disabled = !enabled;
  }

  show(entries: readonly KeptEntry[]): void {
    const empty = make('li', { className: 'none' }, this.words.none);
    const items = entries.map((entry) => this.item(entry));
    this.list.replaceChildren(...(items.length > 0 ? items : [empty]));
    this.enable(this.isEnabled);
  }

  /** Clears the input after saving. */
  clear(): void {
    this.name.value = '';
  }

  private item({ name, words, use, remove }: KeptEntry): HTMLElement {
    const what = make('span', { className: 'what' }, make('b', {}, name), make('small', {}, words));
    const item = make('li', {}, what, makeButton(this.words.use, use, `${this.words.use} ${name}`));
    item.dataset.name = name;
    item.id = `${this.id}-${name}`;
    if (remove) item.append(removeButton(name, remove));
    return item;
  }
}

/** Returns a button that deletes at the second press, because deletion cannot be undone. */
function removeButton(name: string, remove: () => void): HTMLButtonElement {
  const button = makeButton('×', () => {
    if (button.dataset.armed === 'true') return remove();
    button.dataset.armed = 'true';
    button.textContent = 'Delete?';
    window.setTimeout(() => {
      delete button.dataset.armed;
      button.textContent = '×';
    }, kArmedMs);
  });
  button.ariaLabel = `Delete ${name}; press twice`;
  return button;
}

/** Returns a time in the user's locale. */
export function whenInWords(seconds: number): string {
  const date = new Date(1000 * seconds);
  const isToday = date.toDateString() === new Date().toDateString();
  return isToday
    ? date.toLocaleTimeString(undefined, { hour: '2-digit', minute: '2-digit' })
    : date.toLocaleDateString(undefined, { day: 'numeric', month: 'short', year: 'numeric' });
}
