/** An edit that can be undone and redone. Both functions return whether they succeeded. */
export interface Edit {
  /** The text of the edit, such as “added ball”. */
  words: string;
  undo(): Promise<boolean>;
  redo(): Promise<boolean>;
}

const kMost = 100;

/** The list of edits for undo and redo. */
export class Edits {
  private done: Edit[] = [];
  private undone: Edit[] = [];
  private last = Promise.resolve();

  /** `changed` is called after each change of the list. */
  constructor(private readonly changed: () => void) {}

  /** Adds an edit that has just been executed. */
  add(edit: Edit): void {
    this.done = [...this.done, edit].slice(-kMost);
    this.undone = [];
    this.changed();
  }

  /** Clears the list, after a change of the scene. */
  clear(): void {
    this.done = [];
    this.undone = [];
    this.changed();
  }

  get toUndo(): string | undefined {
    return this.done.at(-1)?.words;
  }

  get toRedo(): string | undefined {
    return this.undone.at(-1)?.words;
  }

  undo(): Promise<void> {
    return this.queue(async () => {
      const edit = this.done.pop();
      if (edit && (await edit.undo())) this.undone.push(edit);
    });
  }

  redo(): Promise<void> {
    return this.queue(async () => {
      const edit = this.undone.pop();
      if (edit && (await edit.redo())) this.done.push(edit);
    });
  }

  /**
   * Executes an edit after the previous ones. An edit that fails, for example because another user
   * has removed the body, is deleted from the list.
   */
  private queue(act: () => Promise<void>): Promise<void> {
    this.last = this.last.then(act).then(() => this.changed());
    return this.last;
  }
}
