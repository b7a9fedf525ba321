import type { JoinedColumns } from '../particles/joined_columns';
import { FrothCells } from './froth_cells';
import type { LiquidBody, LiquidTime } from './liquid_body';

/** Limits of the number of neighbours, relative to the number within the liquid. */
const kLone = [0.04, 0.16] as const;
/** Turbulence below the surface makes no foam. */
const kSurface = [0.45, 0.68] as const;

/**
 * Speeds relative to that of a fall from the height of the scene: of isolated particles that become
 * foam, and the standard deviation of turbulent neighbours.
 */
const kSpeed = [0.2, 0.6] as const;
const kTurbulence = [0.07, 0.28] as const;

/** Time after which foam has faded to 1 / e, relative to the time of that fall. */
const kFading = 1.5;
const kGravity = 9.81;

/**
 * Foam and isolation of the particles of all liquids, from 0 to 1. Foam results from isolated fast
 * particles and from turbulence near the surface, and fades. It is a simple form of the potentials of
 * M. Ihmsen et al., "Unified spray, foam and air bubbles for particle-based fluids" (2012), and
 * depends on the displayed frames only.
 */
export class Froth {
  /** The foam of each particle number of each body. */
  private readonly foam = new Map<number, Float32Array>();

  /** Computes the foam of newer columns, and writes it to them. */
  follow(
    liquids: readonly LiquidBody[],
    { columns }: JoinedColumns,
    { quantum, seconds, height }: LiquidTime,
  ): void {
    if (seconds < 0) this.clear();
    const count = liquids.reduce((sum, { columns: { count } }) => sum + count, 0);
    const radius = Math.max(...liquids.map((liquid) => liquid.radius)) / quantum;
    const [center, before] = [columns.center.values, columns.before.values];
    const cells = new FrothCells({ center, before }, count, radius);
    const { values: to } = columns.froth;
    const fall = Math.sqrt(2 * kGravity * height);
    const scale = seconds > 0 ? quantum / seconds / fall : 0;
    const fading = Math.exp(-Math.max(seconds, 0) / (kFading * Math.sqrt((2 * height) / kGravity)));
    let i = 0;
    for (const liquid of liquids) {
      const foam = this.foamOf(liquid);
      for (const end = i + liquid.columns.count; i < end; ++i) {
        const { neighbours, deviation, way } = cells.around(i);
        const lone = 1 - step(kLone, neighbours);
        const spray = lone * step(kSpeed, scale * way);
        const turbulent = (1 - step(kSurface, neighbours)) * step(kTurbulence, scale * deviation);
        const number = columns.names.values[2 * i]!;
        const now = (foam[number] = Math.max(fading * foam[number]!, spray, turbulent));
        to[2 * i] = Math.round(255 * now);
        to[2 * i + 1] = Math.round(255 * lone);
      }
    }
    columns.froth.changed();
  }

  clear(): void {
    this.foam.clear();
  }

  /** Returns the foam of a body, with space for all its particle numbers. */
  private foamOf({ body, columns }: LiquidBody): Float32Array {
    const size = columns.count > 0 ? columns.numberAt(columns.count - 1) + 1 : 0;
    const known = this.foam.get(body);
    if (known && known.length >= size) return known;
    const foam = new Float32Array(2 * size);
    if (known) foam.set(known);
    this.foam.set(body, foam);
    return foam;
  }
}

/** Returns 0 below `low`, 1 above `high`, and a smooth transition between. */
function step([low, high]: readonly [number, number], value: number): number {
  const t = Math.min(Math.max((value - low) / (high - low), 0), 1);
  return t * t * (3 - 2 * t);
}
