import type { Vector } from '../../client/index';
import type { Request } from '../stream/stream';

/**
 * One grab as the server sees it. Moves are sent one at a time: while one is unanswered only the
 * newest target is kept, so that a fast mouse does not flood a slow line.
 */
export class Held {
  private grab: number | undefined;
  private next: Vector | undefined;
  private busy = true;
  private ended = false;

  /** `failed` is told once if the server refuses; the grab is over then. */
  constructor(
    private readonly request: Request,
    start: { body: number; particle: number; target: Vector },
    private readonly failed: (error: unknown) => void,
  ) {
    void this.run(async () => {
      ({ grab: this.grab } = await this.request('grab.start', start));
    });
  }

  move(target: Vector): void {
    this.next = target;
    this.sendNext();
  }

  end(): void {
    this.ended = true;
    this.sendNext();
  }

  private sendNext(): void {
    const { grab, next } = this;
    if (this.busy || grab === undefined) return;
    if (next) {
      this.next = undefined;
      void this.run(() => this.request('grab.move', { grab, target: next }));
    } else if (this.ended) {
      this.grab = undefined;
      void this.run(() => this.request('grab.end', { grab }));
    }
  }

  private async run(action: () => Promise<unknown>): Promise<void> {
    this.busy = true;
    try {
      await action();
      this.busy = false;
      this.sendNext();
    } catch (error) {
      this.grab = undefined;
      this.failed(error);
    }
  }
}
