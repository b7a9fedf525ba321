import { element, onPress } from './elements';

export interface Key {
  /** As `KeyboardEvent.key` gives it, in lower case. */
  keys: readonly string[];
  /** For the list of keys, unless others tell of it. */
  sign?: string;
  words?: string;
  act(key: string): void;
  /** Again and again while it is held. */
  repeats?: boolean;
  /** Only where this has the focus. */
  on?: HTMLElement;
  /** Whether it does something now; by default always. */
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
    const sign = document.createElement('dt');
    const text = document.createElement('kbd');
    text.textContent = key.sign;
    sign.append(text);
    const words = document.createElement('dd');
    words.textContent = key.words;
    this.list.append(sign, words);
  }

  private handle(event: KeyboardEvent): void {
    const { target, repeat } = event;
    const pressed = event.key.toLowerCase(); // Caps Lock makes no difference
    const isPlain = !event.ctrlKey && !event.altKey && !event.metaKey;
    if (!isPlain || isControl(target, pressed)) return;
    if (document.querySelector('dialog[open]')) return; // Escape closes it
    const found = this.all.find(
      ({ keys, on, isEnabled }) =>
        keys.includes(pressed) && (!on || on === target) && (isEnabled?.() ?? true),
    );
    if (!found || (repeat && !found.repeats)) return;
    found.act(pressed);
    event.preventDefault();
  }
}

/** Whether the key means something to the control that has the focus. */
function isControl(target: EventTarget | null, key: string): boolean {
  if (target instanceof HTMLButtonElement) return key === ' ';
  if (target instanceof HTMLInputElement) {
    const isText = ['text', 'number', 'search'].includes(target.type);
    return isText || key === ' ' || key.startsWith('arrow');
  }
  if (target instanceof HTMLElement && target.tagName === 'SUMMARY') return key === ' ';
  return target instanceof HTMLSelectElement || target instanceof HTMLTextAreaElement;
}
