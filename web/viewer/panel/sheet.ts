import { element, onPress } from './elements';

/** The panel on phones: a sheet at the bottom, expanded by a button. */
export class Sheet {
  private readonly panel = element('panel', HTMLElement);
  private readonly button = element('sheet', HTMLButtonElement);

  constructor() {
    onPress(this.button, () => this.show(this.panel.dataset.sheet !== 'open'));
  }

  private show(open: boolean): void {
    this.panel.dataset.sheet = open ? 'open' : 'low';
    this.button.ariaExpanded = String(open);
    this.button.ariaLabel = open ? 'Fewer controls' : 'More controls';
  }
}
