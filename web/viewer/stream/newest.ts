/** Sends values in order. While one is unanswered, only the newest is stored. */
export class Newest<T> {
  private next: { value: T } | undefined;
  private busy = false;

  /** `send` resolves after any reply. */
  constructor(private readonly send: (value: T) => Promise<unknown>) {}

  get isBusy(): boolean {
    return this.busy;
  }

  put(value: T): void {
    this.next = { value };
    if (!this.busy) void this.run();
  }

  private async run(): Promise<void> {
    this.busy = true;
    while (this.next) {
      const { value } = this.next;
      this.next = undefined;
      await this.send(value);
    }
    this.busy = false;
  }
}
