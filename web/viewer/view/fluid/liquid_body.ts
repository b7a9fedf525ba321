import type { GridBody } from '../particles/joined_columns';

/** A liquid body. */
export interface LiquidBody extends GridBody {
  /** Unit of the columns' values. */
  valueQuantum: number;
  /** Particle radius [m]. */
  radius: number;
}

/** The scale and the time of a frame. */
export interface LiquidTime {
  /** Unit of the positions [m]. */
  quantum: number;
  /** Time since the previous frame [s]. */
  seconds: number;
  /** Height of the scene [m]. */
  height: number;
}
