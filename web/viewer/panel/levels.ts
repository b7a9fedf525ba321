import type { Level, SceneLevelsResult, SessionDescription } from '../../client/index';
import { element } from './elements';

type Entry = SceneLevelsResult['levels'][number];

/** Returns the text of a level: its name and its expected speed. */
export function levelText({ level, real_time_factor: factor }: Entry, offered: Level): string {
  const words = `${level} · ${factor < 10 ? factor.toFixed(1) : Math.round(factor)}×`;
  return level === offered ? `✓ ${words}` : words;
}

/**
 * The choice of the level of detail. It shows the expected simulated seconds per second of each
 * level, and marks the level that the server offers.
 */
export class Levels {
  private readonly picker = element('level', HTMLSelectElement);
  private scene: string | undefined;
  private level: Level = 'normal';
  private isEnabled = false;
  private known = false;

  /**
   * `ask` returns the levels of a scene, or undefined for a scene that has none. `load` loads the
   * present scene at a level.
   */
  constructor(
    private readonly ask: (scene: string) => Promise<SceneLevelsResult | undefined>,
    load: (scene: string, level: Level) => void,
  ) {
    this.picker.addEventListener('change', () => {
      if (this.scene !== undefined) load(this.scene, this.picker.value as Level);
      this.picker.blur(); // returns the keys to the page
    });
  }

  enable(enabled: boolean): void {
    this.isEnabled = enabled;
    this.picker.disabled = !(enabled && this.known);
  }

  /** Shows the session's level, also after a rejected choice. */
  describe({ scene, level = 'normal' }: Pick<SessionDescription, 'scene' | 'level'>): void {
    this.level = level;
    if (scene !== this.scene) {
      this.scene = scene;
      void this.fill(scene);
    }
    this.picker.value = level;
  }

  private async fill(scene: string): Promise<void> {
    this.list([]);
    const answer = scene === '' ? undefined : await this.ask(scene);
    if (scene === this.scene && answer) this.list(answer.levels, answer.offered);
  }

  private list(levels: readonly Entry[], offered: Level = 'normal'): void {
    this.known = levels.length > 0;
    const options = levels.map((each) => new Option(levelText(each, offered), each.level));
    this.picker.replaceChildren(...options);
    this.picker.hidden = !this.known;
    this.picker.value = this.level;
    this.enable(this.isEnabled);
  }
}
