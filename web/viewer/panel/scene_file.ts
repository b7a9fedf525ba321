import type { Scene } from '../../client/index';
import { element, onPress } from './elements';

/** The server's message limit [bytes]. */
const kMostBytes = 4 * 1024 * 1024;

/** Reads a scene from a text, or returns the reason why it is invalid. The server checks the rest. */
export function readScene(text: string, file: string): { scene: Scene } | { fault: string } {
  let value: unknown;
  try {
    value = JSON.parse(text);
  } catch {
    return { fault: `“${file}” is not JSON. A scene file is one JSON object.` };
  }
  const isScene =
    typeof value === 'object' &&
    value !== null &&
    (value as { format?: unknown }).format === 'vat.scene/1';
  if (!isScene) return { fault: `“${file}” is not a scene. Its format must be "vat.scene/1".` };
  const scene = value as Scene;
  return { scene: { ...scene, name: scene.name ?? file.replace(/\.json$/i, '').slice(0, 48) } };
}

/** Returns whether a file has the name of a recording. A replay can be followed by another one. */
function isRecording({ name }: File): boolean {
  return /\.vatrec$/i.test(name);
}

export interface SceneFileActions {
  load(scene: Scene): void;
  /** Opens a recording. */
  open(recording: File): void;
  refuse(words: string): void;
}

/** Loads a scene from a file that the user drops on the page or chooses. Opens dropped recordings. */
export class SceneFile {
  private readonly button = element('scene-file', HTMLButtonElement);
  private readonly input = element('scene-file-input', HTMLInputElement);
  private readonly dropHint = element('drop-hint', HTMLElement);

  constructor(private readonly actions: SceneFileActions) {
    onPress(this.button, () => this.input.click());
    this.input.addEventListener('change', () => {
      void this.take(this.input.files?.[0]);
      this.input.value = ''; // allows the same file to be chosen again
    });
    window.addEventListener('dragover', (event) => this.hover(event));
    window.addEventListener('dragleave', (event) => {
      if (!event.relatedTarget) this.dropHint.hidden = true;
    });
    window.addEventListener('drop', (event) => this.drop(event));
  }

  enable(enabled: boolean): void {
    this.button.disabled = !enabled;
  }

  private hover(event: DragEvent): void {
    if (!event.dataTransfer?.types.includes('Files')) return;
    event.preventDefault(); // prevents the browser from opening the file
    this.dropHint.hidden = this.button.disabled;
  }

  private drop(event: DragEvent): void {
    this.dropHint.hidden = true;
    const file = event.dataTransfer?.files[0];
    if (!file) return;
    event.preventDefault();
    if (isRecording(file)) this.actions.open(file);
    else if (!this.button.disabled) void this.take(file);
  }

  private async take(file: File | undefined): Promise<void> {
    if (!file) return;
    if (file.size > kMostBytes) {
      this.actions.refuse(`“${file.name}” is too large. A scene has at most 4 MiB.`);
      return;
    }
    const read = readScene(await file.text(), file.name);
    if ('fault' in read) this.actions.refuse(read.fault);
    else this.actions.load(read.scene);
  }
}
