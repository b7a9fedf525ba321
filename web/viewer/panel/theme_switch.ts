import { element, onPress } from './elements';

type Choice = 'system' | 'light' | 'dark';

const kKey = 'vat.theme';
const kNext: Readonly<Record<Choice, Choice>> = { system: 'dark', dark: 'light', light: 'system' };
const kSigns: Readonly<Record<Choice, string>> = { system: '◐', dark: '☾', light: '☀' };
const kWords: Readonly<Record<Choice, string>> = {
  system: 'system',
  dark: 'dark',
  light: 'light',
};

/** The choice of theme (light, dark, system), stored in the page's attribute `data-theme`. */
export class ThemeSwitch {
  private readonly button = element('theme', HTMLButtonElement);
  private choice: Choice = stored();

  constructor() {
    onPress(this.button, () => this.next());
    this.show();
  }

  next(): void {
    this.choice = kNext[this.choice];
    try {
      localStorage.setItem(kKey, this.choice);
    } catch {
      // Without storage, the choice is lost with the page.
    }
    this.show();
  }

  private show(): void {
    const { dataset } = document.documentElement;
    if (this.choice === 'system') delete dataset.theme;
    else dataset.theme = this.choice;
    this.button.textContent = kSigns[this.choice];
    this.button.ariaLabel = this.button.title = `Theme: ${kWords[this.choice]}`;
  }
}

function stored(): Choice {
  try {
    const found = localStorage.getItem(kKey);
    return found === 'light' || found === 'dark' ? found : 'system';
  } catch {
    return 'system'; // browsers can deny access
  }
}
