/** Something that was done, and can be undone; both tell whether they were. */
export interface Edit {
  /** What was done, as in “added ball”. */
  words: string;
  undo(): Promise<boolean>;
  redo(): Promise<boolean>;
}

const kMost = 100;

/** What was done, to be undone and done again. */
export class Edits {
  private done: Edit[] = [];
  private undone: Edit[] = [];
  private last = Promise.resolve();

  /** `changed`: there is something else to undo. */
  constructor(private readonly changed: () => void) {}

  /** It was done just now. */
  add(edit: Edit): void {
    this.done = [...this.done, edit].slice(-kMost);
    this.undone = [];
    this.changed();
  }

  /** Another scene: nothing of what was done is there. */
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
   * One after the other. What cannot be (un)done any more, as of a body that others removed, is
   * forgotten.
   */
  private queue(act: () => Promise<void>): Promise<void> {
    this.last = this.last.then(act).then(() => this.changed());
    return this.last;
  }
}
