import { BlockData } from './block_data.js';
import { FrameError } from './frame_error.js';
import type { FrameScale } from './header.js';

const kMostKept = 16;

/** A frame in whole steps, on which later ones may build. */
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

/** The last 16 frames from the last key frame on, and one that is being decoded. */
export class FrameRing {
  private readonly frames = Array.from({ length: kMostKept + 1 }, () => new FrameData());
  private next = 0;
  /** Of those before `next`, so many may be referred to. */
  private known = 0;

  /** To be filled; what it was is no frame any more. */
  get free(): FrameData {
    return this.frames[this.next]!;
  }

  /** @throws FrameError where it is not there. */
  find(number: number, epoch: number): FrameData {
    for (let back = 1; back <= this.known; ++back) {
      const frame = this.frames[(this.next + this.frames.length - back) % this.frames.length]!;
      if (frame.number === number && frame.epoch === epoch) return frame;
    }
    throw new FrameError('missing_reference', `frame ${number} is not there`);
  }

  /** The free one is a frame now; with a key frame all others are forgotten. */
  keep(isKey: boolean): void {
    this.known = isKey ? 1 : Math.min(this.known + 1, kMostKept);
    this.next = (this.next + 1) % this.frames.length;
  }
}
