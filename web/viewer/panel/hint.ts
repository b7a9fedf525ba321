import { element } from './elements';

/** Long enough to read it twice. */
const kShownMs = 20_000;

/** How to use the pointer: fades once it was used on the scene, or after a while. */
export class Hint {
  private readonly stage = element('stage', HTMLElement);

  constructor() {
    for (const type of ['pointerdown', 'wheel', 'keydown'] as const) {
      this.stage.addEventListener(type, () => this.fade(), { once: true, passive: true });
    }
  }

  /** The scene is there to be used. */
  begin(): void {
    window.setTimeout(() => this.fade(), kShownMs);
  }

  private fade(): void {
    this.stage.dataset.used = 'true';
  }
}
