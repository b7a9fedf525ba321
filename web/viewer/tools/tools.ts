import type { Gravity } from '../panel/gravity/gravity';
import type { Keys } from '../panel/keys';
import type { HeldMarker } from '../view/held_marker';
import type { View } from '../view/view';
import { TiltTool } from './tilt';
import { ToolBar } from './tool_bar';
import type { Tool } from './tool_bar';

/** The page's functions that the tools use. */
export interface ToolSurroundings {
  /** The marker of drags. */
  readonly marker: HeldMarker;
  /** Selects the effect of a drag of a body; undefined: bodies cannot be dragged. */
  useTool(tool: Exclude<Tool, 'tilt'> | undefined): void;
  /** Shows a temporary message. */
  say(words: string): void;
}

/** The tools of the pointer. While the pointer places a body, no tool is active. */
export class Tools {
  private readonly bar: ToolBar;
  private readonly tilt: TiltTool;
  private tool: Tool = 'grab';
  private isEnabled = false;
  private isPlacing = false;

  constructor(
    keys: Keys,
    private readonly view: View,
    gravity: Gravity,
    private readonly surroundings: ToolSurroundings,
  ) {
    const { marker } = surroundings;
    const say = (words: string): void => surroundings.say(words);
    this.tilt = new TiltTool(keys, view.stage, view.world, marker, gravity, say);
    this.bar = new ToolBar(keys, (tool) => {
      this.tool = tool;
      this.apply();
    });
  }

  enable(enabled: boolean): void {
    this.isEnabled = enabled;
    this.bar.enable(enabled);
    this.apply();
  }

  /** Reports whether the pointer places a body. */
  set placing(isPlacing: boolean) {
    this.isPlacing = isPlacing;
    this.apply();
  }

  private apply(): void {
    const { tool, isEnabled, isPlacing } = this;
    this.tilt.active = isEnabled && !isPlacing && tool === 'tilt';
    this.view.stage.canvas.dataset.tool = tool;
    this.surroundings.useTool(tool === 'tilt' || isPlacing ? undefined : tool);
  }
}
