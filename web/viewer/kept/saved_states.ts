import { formatSeconds } from '../panel/format';
import { ask } from '../panel/desk';
import type { Desk } from '../panel/desk';
import { NamedList, whenInWords } from './named_list';

/** The saved states of this session. Each can be restored repeatedly. */
export class SavedStates {
  readonly list = new NamedList(
    'states',
    'Saved states of this session',
    { use: 'Go back', none: 'No states. Save one to return to it later.' },
    (name) => void this.save(name),
  );

  constructor(private readonly desk: Desk) {}

  async refresh(): Promise<void> {
    const answer = await ask(this.desk, 'session.saves', {});
    if (!answer) return;
    this.list.show(
      answer.states.map(({ name, saved_by: by, saved, time }) => ({
        name,
        words: `at ${formatSeconds(time)} · ${by}, ${whenInWords(saved)}`,
        use: () => void ask(this.desk, 'session.load', { name }),
        remove: () => void this.remove(name),
      })),
    );
  }

  private async save(name: string): Promise<void> {
    if (!(await ask(this.desk, 'session.save', { name }))) return;
    this.list.clear();
    await this.refresh();
  }

  private async remove(name: string): Promise<void> {
    await ask(this.desk, 'session.delete_save', { name });
    await this.refresh();
  }
}
