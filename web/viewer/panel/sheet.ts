import { element, onPress } from './elements';

/** On a phone the panel is a sheet at the bottom, of which a button shows more or less. */
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
