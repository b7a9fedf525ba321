import { element } from './elements';

/** The display time [ms], sufficient for reading twice. */
const kShownMs = 20_000;

/** The help on the pointer. It fades after the first use or after a time. */
export class Hint {
  private readonly stage = element('stage', HTMLElement);

  constructor() {
    for (const type of ['pointerdown', 'wheel', 'keydown'] as const) {
      this.stage.addEventListener(type, () => this.fade(), { once: true, passive: true });
    }
  }

  /** Shows the help, with the first picture. */
  begin(): void {
    window.setTimeout(() => this.fade(), kShownMs);
  }

  private fade(): void {
    this.stage.dataset.used = 'true';
  }
}
