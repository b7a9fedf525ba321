import type { SceneEntry } from '../../client/index';
import { ask } from '../panel/desk';
import type { Desk } from '../panel/desk';
import { NamedList, whenInWords } from './named_list';
import { SceneKeys } from './scene_keys';

/** The users' saved scenes, which any session can load. */
export class SavedScenes {
  readonly list = new NamedList(
    'own-scenes',
    'Shared scenes',
    { use: 'Load', none: 'No scenes. Enter a name to save the loaded scene.' },
    (name) => void this.save(name),
  );
  private readonly keys = new SceneKeys();

  /** `changed` is called after a change of the list. */
  constructor(
    private readonly desk: Desk,
    private readonly load: (name: string) => void,
    private readonly changed: () => void,
  ) {}

  /** Shows the users' scenes among all scenes. */
  show(scenes: readonly SceneEntry[]): void {
    const own = scenes.filter(({ saved_by: by }) => by !== undefined);
    this.list.show(
      own.map(({ name, title, saved_by: by, saved }) => ({
        name,
        words: `${title && title !== name ? `${title} · ` : ''}${by}, ${whenInWords(saved ?? 0)}`,
        use: () => this.load(name),
        ...(this.keys.of(name) !== undefined && { remove: () => void this.remove(name) }),
      })),
    );
  }

  private async save(name: string): Promise<void> {
    const key = this.keys.of(name);
    const answer = await ask(this.desk, 'scene.save', { name, ...(key !== undefined && { key }) });
    if (!answer) return;
    if (answer.key !== undefined) this.keys.put(name, answer.key);
    this.list.clear();
    this.changed();
  }

  private async remove(name: string): Promise<void> {
    const key = this.keys.of(name);
    const params = { name, ...(key !== undefined && { key }) };
    if (await ask(this.desk, 'scene.delete', params)) this.keys.forget(name);
    this.changed();
  }
}
