import { element, onPress } from './elements';

const kKey = 'vat.panel';

/** On phones, the panel is a sheet below the picture, which starts low. */
const kPhone = '(max-width: 760px)';

/**
 * The panel: a slim bar with the most important controls, which a button extends. On desktops, the
 * bar floats over the picture, and the extended panel is beside it. The choice persists there.
 */
export class Sheet {
  private readonly panel = element('panel', HTMLElement);
  private readonly button = element('sheet', HTMLButtonElement);

  constructor() {
    onPress(this.button, () => {
      const open = this.panel.dataset.sheet !== 'open';
      this.show(open);
      if (!matchMedia(kPhone).matches) store(open);
    });
    this.show(!matchMedia(kPhone).matches && stored());
  }

  private show(open: boolean): void {
    this.panel.dataset.sheet = document.body.dataset.panel = open ? 'open' : 'low';
    this.button.ariaExpanded = String(open);
    this.button.ariaLabel = this.button.title = open ? 'Fewer controls' : 'More controls';
  }
}

function store(open: boolean): void {
  try {
    localStorage.setItem(kKey, open ? 'open' : 'low');
  } catch {
    // Without storage, the choice is lost with the page.
  }
}

function stored(): boolean {
  try {
    return localStorage.getItem(kKey) === 'open';
  } catch {
    return false; // browsers can deny access
  }
}
