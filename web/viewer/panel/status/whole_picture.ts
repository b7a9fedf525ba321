import type { FrameHeader, SessionStatus } from '../../../client/index';
import { lossInWords } from './quality';

/**
 * Requests full detail while the session is paused. The server sends coarser frames with fewer
 * particles to slow clients, and a paused session leaves time for the complete picture.
 */
export class WholePicture {
  private shown: FrameHeader | undefined;
  /** The tick of the last request. */
  private askedTick: number | undefined;
  /** The tick of the last status, if no frame of it was shown before. */
  private awaitedTick: number | undefined;

  constructor(private readonly ask: () => void) {}

  showFrame(header: FrameHeader): void {
    // Another scene can be paused at the same tick.
    if (header.epoch !== this.shown?.epoch) this.askedTick = this.awaitedTick = undefined;
    this.shown = header;
  }

  /** Receives the status, which the server sends twice per second. */
  showStatus({ playing, tick }: Pick<SessionStatus, 'playing' | 'tick'>): void {
    if (playing) this.askedTick = this.awaitedTick = undefined;
    if (playing || this.askedTick === tick) return;
    if (!this.shown || lossInWords(this.shown) === undefined) return;
    // The frame can be on its way. If it has not arrived until the next status, the server has
    // omitted it: with the reduced precision, it equals the shown one.
    if (this.shown.tick !== tick && this.awaitedTick !== tick) {
      this.awaitedTick = tick;
      return;
    }
    this.askedTick = tick;
    this.ask();
  }
}
