/** The maximum number of stored samples. */
const kMost = 600;

/** Values of several series over simulated time. Unknown values are gaps. */
export class History<Name extends string> {
  private times: number[] = [];
  private values: Record<Name, (number | null)[]>;

  constructor(private readonly names: readonly Name[]) {
    this.values = this.none();
  }

  /** Adds values at `time` [s]. An earlier time clears the history; the same time merges values. */
  add(time: number, values: Partial<Record<Name, number>>): void {
    const last = this.times.at(-1);
    if (last !== undefined && time < last) this.clear();
    const isNew = last !== time || this.times.length === 0;
    if (isNew) this.times.push(time);
    const place = this.times.length - 1;
    for (const name of this.names) {
      const column = this.values[name];
      column[place] = values[name] ?? column[place] ?? null;
    }
    if (this.times.length > kMost) this.thin();
  }

  clear(): void {
    this.times = [];
    this.values = this.none();
  }

  /** Returns the times and the values of each series in the format of uPlot. */
  columns(names: readonly Name[]): [number[], ...(number | null)[][]] {
    return [this.times, ...names.map((name) => this.values[name])];
  }

  /** Returns the newest known value. */
  newest(name: Name): number | undefined {
    const known = this.values[name].filter((value) => value !== null);
    return known.at(-1);
  }

  /** Removes every other sample of the older half, so that the beginning remains visible. */
  private thin(): void {
    const half = Math.floor(this.times.length / 2);
    const stays = (_: unknown, n: number): boolean => n >= half || n % 2 === 0;
    this.times = this.times.filter(stays);
    for (const name of this.names) this.values[name] = this.values[name].filter(stays);
  }

  private none(): Record<Name, (number | null)[]> {
    return Object.fromEntries(this.names.map((name) => [name, []])) as unknown as Record<
      Name,
      (number | null)[]
    >;
  }
}
