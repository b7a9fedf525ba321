import { BlockData } from './block_data.js';
import { FrameError } from './frame_error.js';
import type { FrameScale } from './header.js';

const kMostKept = 16;

/** A quantised frame, to which later frames can refer. */
export class FrameData {
  epoch = 0;
  number = 0;
  scale: FrameScale = { origin: [0, 0, 0], quantum: 1, attributeQuanta: [0, 0, 0, 0] };
  blockCount = 0;
  private readonly blocks: BlockData[] = [];

  resize(count: number): void {
    this.blockCount = count;
    while (this.blocks.length < count) this.blocks.push(new BlockData());
  }

  block(index: number): BlockData {
    return this.blocks[index]!;
  }

  check(): number {
    let check = 0;
    for (let b = 0; b < this.blockCount; ++b) check = this.block(b).addTo(check);
    return check >>> 0;
  }
}

/** The last 16 frames since the last key frame, and the frame that is being decoded. */
export class FrameRing {
  private readonly frames = Array.from({ length: kMostKept + 1 }, () => new FrameData());
  private next = 0;
  /** The number of possible references before `next`. */
  private known = 0;

  /** The frame to decode to. Its previous content is discarded. */
  get free(): FrameData {
    return this.frames[this.next]!;
  }

  /** @throws FrameError if the frame is not stored. */
  find(number: number, epoch: number): FrameData {
    for (let back = 1; back <= this.known; ++back) {
      const frame = this.frames[(this.next + this.frames.length - back) % this.frames.length]!;
      if (frame.number === number && frame.epoch === epoch) return frame;
    }
    throw new FrameError('missing_reference', `frame ${number} is not stored`);
  }

  /** Stores the free frame. A key frame discards all others. */
  keep(isKey: boolean): void {
    this.known = isKey ? 1 : Math.min(this.known + 1, kMostKept);
    this.next = (this.next + 1) % this.frames.length;
  }
}
