/** The range of values that colours distinguish. */
export interface Range {
  min: number;
  max: number;
}

/** The share of the unused width that is removed per frame. */
const kShrink = 0.04;

/** An automatic range. It widens immediately and narrows slowly, so that colours do not flicker. */
export class AutoRange {
  private current: Range | undefined;

  /** If `isDiverging`, 0 is the centre of the range for values of both signs. */
  constructor(private readonly isDiverging: boolean) {}

  get range(): Range {
    const { min, max } = this.current ?? { min: 0, max: 1 };
    if (this.isDiverging && min < 0 && max > 0) {
      const most = Math.max(-min, max);
      return { min: -most, max: most };
    }
    if (max > min) return { min, max };
    // A quantity without a sign has no negative values, for example the speed of a body at rest.
    return { min: min < 0 ? min - 0.5 : Math.max(min - 0.5, 0), max: max + 0.5 };
  }

  add({ min, max }: Range): void {
    if (!(min <= max)) return; // no values
    const { current } = this;
    if (!current) this.current = { min, max };
    else {
      current.min = Math.min(min, current.min + kShrink * (min - current.min));
      current.max = Math.max(max, current.max + kShrink * (max - current.max));
    }
  }
}
