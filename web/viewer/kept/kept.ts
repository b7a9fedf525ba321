import type { SceneEntry, ServerInfo, SessionDescription } from '../../client/index';
import { element, make } from '../panel/elements';
import type { Desk } from '../panel/desk';
import { Recordings } from './recordings';
import { SavedScenes } from './saved_scenes';
import { SavedStates } from './saved_states';
import './kept.css';

export interface KeptActions {
  load(scene: string): void;
  /** Called after scenes were saved or deleted. */
  scenesChanged(): void;
  go(session: string): void;
  /** Plays a recording of frames. */
  play(file: File): void;
}

/** The section of saved states, scenes and recordings. */
export class Kept {
  private readonly section = element('kept-details', HTMLDetailsElement);
  private readonly note = make('p', { id: 'kept-note', className: 'soft', hidden: true });
  private readonly states: SavedStates;
  private readonly scenes: SavedScenes;
  private readonly recordings: Recordings;
  private session = '';
  private isEnabled = false;

  constructor(desk: Desk, actions: KeptActions) {
    this.states = new SavedStates(desk);
    this.scenes = new SavedScenes(desk, actions.load, actions.scenesChanged);
    this.recordings = new Recordings(desk, () => this.session, actions);
    element('kept-place', HTMLElement).append(this.note);
    this.section.addEventListener('toggle', () => {
      if (!this.section.open || !this.isEnabled) return;
      void this.states.refresh();
      actions.scenesChanged(); // other users save scenes too
    });
  }

  enable(enabled: boolean, isReplay: boolean): void {
    this.isEnabled = enabled;
    this.states.list.enable(enabled && !isReplay);
    this.scenes.list.enable(enabled && !isReplay);
    this.recordings.enable(enabled, isReplay);
  }

  openRecording(file: File): Promise<void> {
    return this.recordings.open(file);
  }

  describe({ session }: SessionDescription): void {
    const isNew = session !== this.session;
    this.session = session;
    if (isNew && this.section.open) void this.states.refresh();
  }

  showScenes(scenes: readonly SceneEntry[]): void {
    this.scenes.show(scenes);
  }

  showServer({ storage }: ServerInfo): void {
    this.note.hidden = storage !== 'memory';
    this.recordings.showServer(storage !== 'memory');
    this.note.textContent =
      'This server has no data folder. All saved states and scenes are lost when the server ends.';
  }
}
