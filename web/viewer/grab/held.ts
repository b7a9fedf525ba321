import type { Vector } from '../../client/index';
import type { Request } from '../stream/stream';

/** Well within the time after which the server ends a grab that nobody moves [ms]. */
export const kRenewal = 5000;

/**
 * One grab as the server sees it. Moves are sent one at a time: while one is unanswered only the
 * newest target is kept, so that a fast mouse does not flood a slow line. A pointer that holds still
 * sends its target again from time to time: it still holds.
 */
export class Held {
  private grab: number | undefined;
  private next: Vector | undefined;
  private busy = true;
  private ended = false;
  private target: Vector;
  private readonly renewal: ReturnType<typeof setInterval>;

  /** `failed` is told once if the server refuses; the grab is over then. */
  constructor(
    private readonly request: Request,
    start: { body: number; particle: number; target: Vector },
    private readonly failed: (error: unknown) => void,
  ) {
    this.target = start.target;
    this.renewal = setInterval(() => this.move(this.target), kRenewal);
    void this.run(async () => {
      ({ grab: this.grab } = await this.request('grab.start', start));
    });
  }

  move(target: Vector): void {
    this.next = this.target = target;
    this.sendNext();
  }

  end(): void {
    this.ended = true;
    clearInterval(this.renewal);
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
      clearInterval(this.renewal);
      this.failed(error);
    }
  }
}
