import type { Vector } from '../../../client/index';
import type { GridBody } from '../particles/joined_columns';

/** A liquid body. */
export interface LiquidBody extends GridBody {
  /** Unit of the columns' values. */
  valueQuantum: number;
  /** Particle radius [m]. */
  radius: number;
}

/** The grid and the time of a frame. */
export interface LiquidTime {
  /** The coordinate 0 of positions [m], and their unit [m]. */
  origin: Readonly<Vector>;
  quantum: number;
  /** Time since the previous frame [s]. */
  seconds: number;
  /** Height of the scene [m]. */
  height: number;
}
