import { element, onPress } from '../panel/elements';
import type { Keys } from '../panel/keys';
import './tools.css';

/** The tools of the pointer, and the words for the list of keys. */
const kTools = {
  grab: 'the pointer pulls bodies',
  push: 'the pointer pushes bodies',
  tilt: 'the pointer tilts gravity',
} as const;

export type Tool = keyof typeof kTools;

/** The choice of the tool that the pointer and the keys use on the picture. */
export class ToolBar {
  private readonly buttons = new Map<Tool, HTMLButtonElement>();
  private isEnabled = false;

  constructor(
    keys: Keys,
    private readonly choose: (tool: Tool) => void,
  ) {
    (Object.keys(kTools) as Tool[]).forEach((tool, i) => {
      const button = element(`tool-${tool}`, HTMLButtonElement);
      this.buttons.set(tool, button);
      onPress(button, () => this.select(tool));
      const key = String(i + 1);
      keys.add({
        keys: [key],
        sign: key,
        words: `tool: ${kTools[tool]}`,
        act: () => this.select(tool),
        isEnabled: () => this.isEnabled,
      });
    });
  }

  enable(enabled: boolean): void {
    this.isEnabled = enabled;
    for (const button of this.buttons.values()) button.disabled = !enabled;
  }

  private select(chosen: Tool): void {
    for (const [tool, button] of this.buttons) button.ariaPressed = String(tool === chosen);
    this.choose(chosen);
  }
}
