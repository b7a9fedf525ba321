import type { BlockData } from './block_data.js';
import type { CellOrder } from './cell_order.js';
import { kGrowth } from './room.js';

/** The place of what is not there. */
export const kNone = -1;

/** The particles of the first reference, and where they are in the other frames. */
export interface Matched {
  first: BlockData;
  second: BlockData | undefined;
  cells: CellOrder;
  /** By particle of the first reference: its place in the second, and in the new block. */
  secondPlaces: Int32Array;
  newPlaces: Int32Array;
}

/** The particles that stay, cell by cell. Keeps its memory. */
export class KeptParticles {
  /** By cell: where its particles end. */
  ends = new Int32Array(1);
  /** Their places in the new block. */
  targets = new Int32Array(0);
  /** Three of each: first what is predicted, then what it is. */
  values = new Int32Array(0);

  reserve(count: number): void {
    if (this.targets.length >= count) return;
    const room = Math.ceil(kGrowth * count);
    this.ends = new Int32Array(room + 1);
    this.targets = new Int32Array(room);
    this.values = new Int32Array(3 * room);
  }
}
