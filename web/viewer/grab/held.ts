import type { Vector } from '../../client/index';
import type { Request } from '../stream/stream';
import type { Holding, Start } from './holding';

/** The interval of renewal [ms], shorter than the server's time-out of idle grabs. */
export const kRenewal = 5000;

/**
 * A grab on the server. While a move is unanswered, only the newest target is stored, so that fast
 * pointers do not flood slow connections. A resting pointer repeats its target to renew the grab.
 */
export class Held implements Holding {
  private grab: number | undefined;
  private next: Vector | undefined;
  private busy = true;
  private ended = false;
  private target: Vector;
  private readonly renewal: ReturnType<typeof setInterval>;

  /** `failed` is called once if the server rejects the grab, which then ends. */
  constructor(
    private readonly request: Request,
    start: Start,
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
