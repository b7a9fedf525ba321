import type { Scene } from '../../../client/index';
import { make, makeButton } from '../../panel/elements';
import type { Change, ParameterForm } from './parameter_form';
import { ValueField } from './value_field';

type Numerics = NonNullable<Scene['numerics']>;
type Integrator = NonNullable<Numerics['integrator']>;

const kIntegrators: Readonly<Record<Integrator, string>> = {
  velocity_verlet: 'Velocity Verlet',
  runge_kutta_4: 'Runge–Kutta 4',
  heun: 'Heun',
  symplectic_euler: 'Euler, symplectic',
  explicit_euler: 'Euler, explicit',
};

/** The defaults in SCENE.md; times in s. */
const kDefaults = { integrator: 'velocity_verlet', step: 0.001, tick: 0.02 } as const;
const kLongest = 0.1;
const kMostSteps = 10_000;

/** The form for integrator and step of the running scene. */
export class NumericsForm implements ParameterForm {
  readonly element: HTMLElement;
  private readonly integrator = make('select', { id: 'integrator' });
  private readonly reset: HTMLButtonElement;
  private readonly fault = make('p', { className: 'fault', role: 'alert', hidden: true });
  private readonly place = make('div');
  private steps: ValueField | undefined;
  private tick = 0;
  private numerics: Required<Pick<Numerics, 'integrator' | 'step'>> = kDefaults;
  private initial: Numerics = {};
  private isEnabled = false;

  constructor(private readonly change: Change<'world.set_numerics'>) {
    for (const [value, words] of Object.entries(kIntegrators)) {
      this.integrator.add(new Option(words, value));
    }
    this.reset = makeButton('↺', () => void this.goBack(), 'Reset Integrator');
    this.integrator.addEventListener('change', () => void this.set(this.integrator.value));
    const label = make('label', { htmlFor: 'integrator' }, 'Integrator');
    const row = make('div', { className: 'parameter choice' }, label, this.integrator, this.reset);
    row.append(this.fault);
    this.element = make('div', {}, make('h3', {}, 'Time steps'), row, this.place);
  }

  enable(enabled: boolean): void {
    this.isEnabled = enabled;
    this.integrator.disabled = !enabled;
    this.reset.disabled = !enabled;
    this.steps?.enable(enabled);
  }

  show({ numerics = {} }: Scene, { numerics: initial = {} }: Scene): void {
    const { tick = kDefaults.tick } = numerics;
    this.numerics = { ...kDefaults, ...numerics };
    this.initial = initial.accuracy === undefined ? { ...kDefaults, ...initial } : {};
    if (tick !== this.tick || !this.steps) this.makeSteps(tick);
    const { integrator, step } = this.numerics;
    this.integrator.value = integrator;
    this.reset.hidden = [undefined, integrator].includes(this.initial.integrator);
    const count = (of: number | undefined): number | undefined => of && Math.round(tick / of);
    const length = `of ${Number((1000 * step).toPrecision(4))} ms`;
    this.steps!.show(count(step), count(this.initial.step), length);
    this.enable(this.isEnabled);
  }

  private makeSteps(tick: number): void {
    this.tick = tick;
    const range = { min: Math.max(Math.ceil(tick / kLongest), 1), max: kMostSteps };
    const label = `Steps in ${Number((1000 * tick).toPrecision(4))} ms`;
    const spec = { id: 'steps', label, unit: '', ...range, isWhole: true };
    this.steps = new ValueField(spec, (count) => this.change(() => ({ step: tick / count! })));
    this.place.replaceChildren(this.steps.element);
  }

  private async goBack(): Promise<void> {
    if (this.initial.integrator) await this.set(this.initial.integrator);
  }

  private async set(integrator: string): Promise<void> {
    const fault = await this.change(() => ({ integrator }));
    this.fault.textContent = fault ?? '';
    this.fault.hidden = fault === undefined;
    this.integrator.value = this.numerics.integrator;
  }
}
