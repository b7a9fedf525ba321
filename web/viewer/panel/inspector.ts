import type { SessionDescription } from '../../client/index';
import { element, make } from './elements';
import { formatCount } from './format';

/** Position of a particle, and the simulated time. */
export interface Sample {
  position: { x: number; y: number; z: number };
  radius: number;
  /** Number of particles of its body. */
  particles: number;
  time: number;
}

/** The update interval of the numbers [ms]. */
const kPeriodMs = 250;

/** The figures of a clicked particle and of its body. */
export class Inspector {
  private readonly card = element('inspector', HTMLElement);
  private chosen: { body: number; particle: number } | undefined;
  private before: Sample | undefined;
  private speed: number | undefined;
  private writtenAt = -Infinity;
  private known: [string, string][] | undefined;

  /** `matter` returns rows about a body, from its name and number of particles. */
  constructor(
    private readonly sample: (body: number, particle: number) => Sample | undefined,
    private readonly matter: (name: string, particles: number) => Promise<[string, string][]>,
  ) {}

  inspect(body: number, particle: number): void {
    this.chosen = { body, particle };
    this.known = undefined;
    this.before = this.speed = undefined;
    this.writtenAt = -Infinity;
  }

  close(): void {
    this.chosen = undefined;
    this.card.hidden = true;
  }

  /** Updates the figures. */
  update(description: SessionDescription | undefined): void {
    const { chosen } = this;
    const now = performance.now();
    if (!chosen || now - this.writtenAt < kPeriodMs) return;
    this.writtenAt = now;
    const sample = this.sample(chosen.body, chosen.particle);
    const body = description?.bodies.find((candidate) => candidate.body === chosen.body);
    if (!sample || !body) return this.close(); // the particle was removed
    this.measure(sample);
    if (!this.known) void this.learn(body.name, sample.particles);
    const { x, y, z } = sample.position;
    this.write(`${body.name} · particle ${chosen.particle}`, [
      ['Kind', body.kind],
      ['Material', body.material],
      ...(this.known ?? []),
      ['Particles', formatCount(sample.particles)],
      ['Position', `${x.toFixed(3)}, ${y.toFixed(3)}, ${z.toFixed(3)} m`],
      ['Speed', this.speed === undefined ? '–' : `${this.speed.toFixed(2)} m/s`],
      ['Radius', `${(1000 * sample.radius).toFixed(1)} mm`],
    ]);
  }

  private async learn(name: string, particles: number): Promise<void> {
    this.known = [];
    const { chosen } = this;
    const rows = await this.matter(name, particles);
    if (chosen === this.chosen) this.known = rows;
  }

  /** Measures the mean speed since the last update. A reset clears it. */
  private measure(sample: Sample): void {
    const { before } = this;
    this.before = sample;
    if (!before || sample.time <= before.time) {
      if (before && sample.time < before.time) this.speed = undefined;
      return;
    }
    const [a, b] = [before.position, sample.position];
    this.speed = Math.hypot(b.x - a.x, b.y - a.y, b.z - a.z) / (sample.time - before.time);
  }

  private write(title: string, rows: [string, string][]): void {
    const close = this.card.querySelector('button') ?? this.closeButton();
    const list = make('dl');
    for (const [name, value] of rows) list.append(make('dt', {}, name), make('dd', {}, value));
    this.card.replaceChildren(make('header', {}, title, close), list);
    this.card.hidden = false;
  }

  private closeButton(): HTMLButtonElement {
    const properties = { type: 'button', className: 'icon', ariaLabel: 'Close' } as const;
    const close = make('button', properties, '×');
    close.addEventListener('click', () => this.close());
    return close;
  }
}
