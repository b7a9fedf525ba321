import type { FrameHeader, SessionStatus } from '../../client/index';
import { lossInWords } from '../panel/quality';

/**
 * Who is too slow for a session's frames is sent coarser ones, of fewer particles. Where the session
 * stands still there is time for the whole picture, which has to be asked for.
 */
export class WholePicture {
  private shown: FrameHeader | undefined;
  /** For which it was asked. */
  private askedTick: number | undefined;

  constructor(private readonly ask: () => void) {}

  showFrame(header: FrameHeader): void {
    this.shown = header;
  }

  /** The server sends it twice a second. */
  showStatus({ playing, tick }: Pick<SessionStatus, 'playing' | 'tick'>): void {
    if (playing) this.askedTick = undefined;
    if (playing || this.shown?.tick !== tick || this.askedTick === tick) return;
    if (lossInWords(this.shown) === undefined) return;
    this.askedTick = tick;
    this.ask();
  }
}
