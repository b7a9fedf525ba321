import { FrameError } from './frame/frame_error.js';
import { FrameBlocks } from './frame/frame_blocks.js';
import { emptyFrame, writeBlocks } from './frame/frame_output.js';
import type { Frame } from './frame/frame_output.js';
import { FrameRing } from './frame/frame_ring.js';
import { HeaderBytes } from './frame/header.js';
import { SymbolReader } from './frame/symbols.js';

export { BodyKind } from './frame/block_data.js';
export { FrameError } from './frame/frame_error.js';
export type { FrameErrorCode } from './frame/frame_error.js';
export { emptyFrame } from './frame/frame_output.js';
export type { Frame, FrameBlock, GridBlock, PoseBlock, VatBlock } from './frame/frame_output.js';
export { frameNumber } from './frame/header.js';
export type { FrameHeader, FrameScale } from './frame/header.js';

/** Decodes the frames of one connection in order: protocol/FRAMES.md. */
export class FrameDecoder {
  private readonly ring = new FrameRing();
  private readonly symbols = new SymbolReader();
  private readonly blocks = new FrameBlocks(this.symbols);
  private last = 0;
  private dropped = 0;
  private isWaiting = false;

  /** Whether a frame was invalid. Frames that refer to it are then invalid, until the next key frame. */
  get needsKey(): boolean {
    return this.isWaiting;
  }

  /**
   * Decodes to `into`, which is overwritten. Reuses its memory if it is large enough.
   * @throws FrameError with the first error of an invalid frame; the decoder then does not change.
   */
  decode(buffer: ArrayBuffer, into: Frame = emptyFrame()): Frame {
    const wasWaiting = this.isWaiting;
    this.isWaiting = true;
    const isKey = this.read(buffer, into);
    this.isWaiting = wasWaiting && !isKey;
    return into;
  }

  /** Returns whether it is a key frame. */
  private read(buffer: ArrayBuffer, into: Frame): boolean {
    const header = new HeaderBytes(buffer);
    const { isKey, number, epoch } = header;
    const [back1, back2] = header.distances;
    const scale = isKey ? header.readScale() : undefined;
    const first = isKey ? undefined : this.ring.find((number - back1) >>> 0, epoch);
    const second = back2 === 0 ? undefined : this.ring.find((number - back2) >>> 0, epoch);
    const frame = this.ring.free;
    frame.number = number;
    frame.epoch = epoch;
    frame.scale = scale ?? first?.scale ?? frame.scale;
    this.symbols.start(buffer, header.symbolsBegin);
    if (first) this.blocks.readDelta(frame, first, second);
    else this.blocks.readKey(frame);
    this.symbols.end();
    if (frame.check() !== header.check) {
      throw new FrameError('bad_check', 'the check differs');
    }
    this.ring.keep(isKey);
    this.countDropped(number, header.stride);
    header.write(into.header, frame.scale);
    into.dropped = this.dropped;
    writeBlocks(frame, into);
    return isKey;
  }

  private countDropped(number: number, stride: number): void {
    if (this.last > 0 && number > this.last) {
      this.dropped += Math.max(0, Math.round((number - this.last) / stride) - 1);
    }
    this.last = number;
  }
}
