/** So many samples are kept. */
const kMost = 600;

/** Values over simulated time, each of some series; those that are not known are gaps. */
export class History<Name extends string> {
  private times: number[] = [];
  private values: Record<Name, (number | null)[]>;

  constructor(private readonly names: readonly Name[]) {
    this.values = this.none();
  }

  /** At `time` [s]; a time before the last one begins anew, and the same once more adds to it. */
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

  /** The times, and behind them the values of each of these series, as uPlot takes them. */
  columns(names: readonly Name[]): [number[], ...(number | null)[][]] {
    return [this.times, ...names.map((name) => this.values[name])];
  }

  /** The newest value that is known. */
  newest(name: Name): number | undefined {
    const known = this.values[name].filter((value) => value !== null);
    return known.at(-1);
  }

  /** Leaves out every other sample of the older half: the beginning stays in sight. */
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
