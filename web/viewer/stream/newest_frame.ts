import type { Frame } from '../../client/index';

/** The server and the worker, as far as frames go back to them. */
export interface FrameGivers {
  acknowledge(number: number): void;
  /** Takes a frame that is not needed any more. */
  reuse(frame: Frame): void;
}

/**
 * Keeps the newest frame until it is drawn, and that until the next one is. Frames that are never
 * drawn must be acknowledged all the same: once the server's window is full of unacknowledged ones,
 * it sends no more.
 */
export class NewestFrame {
  private frame: Frame | undefined;
  private taken: Frame | undefined;

  constructor(private readonly givers: FrameGivers) {}

  put(frame: Frame): void {
    if (this.frame) this.givers.reuse(this.frame);
    this.frame = frame;
  }

  /** The frame that came in since the last call; it and all before it are acknowledged. */
  take(): Frame | undefined {
    const { frame } = this;
    this.frame = undefined;
    if (frame) this.givers.acknowledge(frame.header.number);
    return frame;
  }

  /** As take() with a frame that is not shown. */
  skip(): void {
    const frame = this.take();
    if (frame) this.givers.reuse(frame);
  }

  /** The frame is in use now, and the one before it is not any more. */
  use(frame: Frame): void {
    if (this.taken) this.givers.reuse(this.taken);
    this.taken = frame;
  }

  /** Without a word to the server: the subscription that the frame belonged to has ended. */
  forget(): void {
    if (this.frame) this.givers.reuse(this.frame);
    this.frame = undefined;
  }
}
