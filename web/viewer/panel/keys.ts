import { element, make, onPress } from './elements';

export interface Key {
  /** Values of `KeyboardEvent.key` in lower case. */
  keys: readonly string[];
  /** The text in the list of keys; undefined if it is not listed. */
  sign?: string;
  words?: string;
  act(key: string): void;
  /** Whether the action repeats while the key is held. */
  repeats?: boolean;
  /** The element that must have the focus. */
  on?: HTMLElement;
  /** Whether the key is active; by default always. */
  isEnabled?(): boolean;
}

/** The keys of the page, and the dialog that lists them. */
export class Keys {
  private readonly all: Key[] = [];
  private readonly dialog = element('keys', HTMLDialogElement);
  private readonly list = element('keys-list', HTMLElement);

  constructor() {
    onPress(element('keys-open', HTMLButtonElement), () => this.dialog.showModal());
    window.addEventListener('keydown', (event) => this.handle(event));
    this.add({
      keys: ['?'],
      sign: '?',
      words: 'this help',
      act: () => this.dialog.showModal(),
    });
  }

  add(key: Key): void {
    this.all.push(key);
    if (key.sign === undefined || key.words === undefined) return;
    const sign = make('dt', {}, make('kbd', {}, key.sign));
    this.list.append(sign, make('dd', {}, key.words));
  }

  private handle(event: KeyboardEvent): void {
    const { target, repeat } = event;
    const pressed = event.key.toLowerCase(); // independent of Caps Lock
    const isPlain = !event.ctrlKey && !event.altKey && !event.metaKey;
    if (!isPlain || isControl(target, pressed)) return;
    if (document.querySelector('dialog[open]')) return; // Escape closes the dialog
    const found = this.all.find(
      ({ keys, on, isEnabled }) =>
        keys.includes(pressed) && (!on || on === target) && (isEnabled?.() ?? true),
    );
    if (!found || (repeat && !found.repeats)) return;
    found.act(pressed);
    event.preventDefault();
  }
}

/** Returns whether the focused control uses the key. */
function isControl(target: EventTarget | null, key: string): boolean {
  if (target instanceof HTMLButtonElement) return key === ' ';
  if (target instanceof HTMLInputElement) {
    const isText = ['text', 'number', 'search'].includes(target.type);
    return isText || key === ' ' || key.startsWith('arrow');
  }
  if (target instanceof HTMLElement && target.tagName === 'SUMMARY') return key === ' ';
  return target instanceof HTMLSelectElement || target instanceof HTMLTextAreaElement;
}
