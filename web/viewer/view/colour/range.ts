/** From the least to the greatest value that colours tell apart. */
export interface Range {
  min: number;
  max: number;
}

/** Of its width: how much of what is left over goes away with each frame. */
const kShrink = 0.04;

/** Follows the values shown: widens at once, narrows slowly, so that colours do not flicker. */
export class AutoRange {
  private current: Range | undefined;

  /** What of a diverging map's middle stands for 0 where values have both signs. */
  constructor(private readonly isDiverging: boolean) {}

  get range(): Range {
    const { min, max } = this.current ?? { min: 0, max: 1 };
    if (this.isDiverging && min < 0 && max > 0) {
      const most = Math.max(-min, max);
      return { min: -most, max: most };
    }
    return max > min ? { min, max } : { min: min - 0.5, max: max + 0.5 };
  }

  add({ min, max }: Range): void {
    if (!(min <= max)) return; // of no values
    const { current } = this;
    if (!current) this.current = { min, max };
    else {
      current.min = Math.min(min, current.min + kShrink * (min - current.min));
      current.max = Math.max(max, current.max + kShrink * (max - current.max));
    }
  }
}
