import { element } from './elements';

/** The display time [ms], sufficient for reading twice. */
const kShownMs = 20_000;

const kKey = 'vat.hint';

/** The help on the pointer at the first visit. It fades after the first use or after a time. */
export class Hint {
  private readonly stage = element('stage', HTMLElement);

  constructor() {
    if (wasShown()) this.stage.dataset.used = 'true';
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
    try {
      localStorage.setItem(kKey, 'shown');
    } catch {
      // Without storage, the help appears at every visit.
    }
  }
}

function wasShown(): boolean {
  try {
    return localStorage.getItem(kKey) !== null;
  } catch {
    return false; // browsers can deny access
  }
}
