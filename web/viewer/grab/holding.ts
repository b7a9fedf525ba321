import type { Vector } from '../../client/index';

/** The particle at which a drag begins. */
export interface Start {
  body: number;
  particle: number;
  /** Position of the particle [m]. */
  target: Vector;
}

/** The effect of a drag of a body. */
export interface Holding {
  /** Moves the target [m]. */
  move(target: Vector): void;
  /** Ends the drag. `isDone`: the user has completed it; otherwise it is cancelled. */
  end(isDone: boolean): void;
}

/** Begins the effect of a drag. `failed` is called once if the server rejects it, which ends it. */
export type HoldingMaker = (start: Start, failed: (error: unknown) => void) => Holding;
