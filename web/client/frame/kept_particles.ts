import type { BlockData } from './block_data.js';
import type { CellOrder } from './cell_order.js';
import { kGrowth } from './room.js';

/** The index of an absent particle. */
export const kNone = -1;

/** The particles of the first reference, and their indices in the other frames. */
export interface Matched {
  first: BlockData;
  second: BlockData | undefined;
  cells: CellOrder;
  /** By particle of the first reference: its index in the second reference and in the new block. */
  secondPlaces: Int32Array;
  newPlaces: Int32Array;
}

/** The remaining particles, cell by cell. Reuses its memory. */
export class KeptParticles {
  /** By cell: the end of its particles. */
  ends = new Int32Array(1);
  /** Their indices in the new block. */
  targets = new Int32Array(0);
  /** Three values per particle: first the predictions, then the decoded values. */
  values = new Int32Array(0);

  reserve(count: number): void {
    if (this.targets.length >= count) return;
    const room = Math.ceil(kGrowth * count);
    this.ends = new Int32Array(room + 1);
    this.targets = new Int32Array(room);
    this.values = new Int32Array(3 * room);
  }
}
