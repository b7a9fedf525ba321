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

  constructor(private readonly ask: () => void) {}

  showFrame(header: FrameHeader): void {
    this.shown = header;
  }

  /** Receives the status, which the server sends twice per second. */
  showStatus({ playing, tick }: Pick<SessionStatus, 'playing' | 'tick'>): void {
    if (playing) this.askedTick = undefined;
    if (playing || this.shown?.tick !== tick || this.askedTick === tick) return;
    if (lossInWords(this.shown) === undefined) return;
    this.askedTick = tick;
    this.ask();
  }
}
