import type { Frame } from '../../client/index';

/**
 * Keeps the newest frame until it is drawn. Frames that are never drawn must be acknowledged all
 * the same: once the server's window is full of unacknowledged ones, it sends no more.
 */
export class NewestFrame {
  private frame: Frame | undefined;

  constructor(private readonly acknowledge: (number: number) => void) {}

  put(frame: Frame): void {
    this.frame = frame;
  }

  /** The frame that came in since the last call; it and all before it are acknowledged. */
  take(): Frame | undefined {
    const frame = this.frame;
    this.frame = undefined;
    if (frame) this.acknowledge(frame.header.number);
    return frame;
  }

  /** Without a word to the server: the subscription that the frame belonged to has ended. */
  forget(): void {
    this.frame = undefined;
  }
}
