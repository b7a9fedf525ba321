import { make, makeButton } from '../panel/elements';

/** A number that can be changed, with its unit and range. */
export interface ValueSpec {
  id: string;
  label: string;
  unit: string;
  min: number;
  max: number;
  isWhole?: boolean;
  /** What there is without a number; where there has to be one, nothing. */
  otherwise?: string;
}

/** Tells what is wrong with it; undefined: it is so now. */
export type SetValue = (value: number | undefined) => Promise<string | undefined>;

/** A field for a number: label and unit, range, the way back, and below it what is wrong. */
export class ValueField {
  readonly element: HTMLElement;
  private readonly input: HTMLInputElement;
  private readonly reset: HTMLButtonElement;
  private readonly unit = make('small');
  private readonly fault = make('p', { className: 'fault', role: 'alert', hidden: true });
  private initial: number | undefined;
  private value: number | undefined;

  constructor(
    private readonly spec: ValueSpec,
    private readonly set: SetValue,
  ) {
    const { id, label, unit, min, max, isWhole, otherwise } = spec;
    const step = isWhole ? '1' : 'any';
    this.input = make('input', { id, type: 'number', step, placeholder: otherwise ?? '' });
    [this.input.min, this.input.max] = [String(min), String(max)];
    this.input.title = `From ${min} to ${max}`;
    this.input.addEventListener('change', () => void this.change());
    this.reset = makeButton('↺', () => void this.apply(this.initial), `Reset ${label}`);
    this.unit.textContent = unit;
    const words = make('label', { htmlFor: id }, label, this.unit);
    const { input, reset, fault } = this;
    this.element = make('div', { className: 'parameter' }, words, input, reset, fault);
  }

  /** `initial`: as the scene was loaded; `unit`: in place of the usual words. */
  show(value: number | undefined, initial: number | undefined, unit = this.spec.unit): void {
    this.value = value;
    this.initial = initial;
    this.unit.textContent = unit;
    // What is being written stays.
    if (document.activeElement !== this.input) this.input.value = this.text;
    const hasWay = initial !== undefined || this.spec.otherwise !== undefined;
    this.reset.hidden = !hasWay || initial === value;
  }

  enable(enabled: boolean): void {
    this.input.disabled = !enabled;
    this.reset.disabled = !enabled;
  }

  private get text(): string {
    return this.value === undefined ? '' : String(this.value);
  }

  private async change(): Promise<void> {
    const { input, spec } = this;
    const isLeftOut = input.value === '' && !input.validity.badInput;
    const isGood = input.checkValidity() && (!isLeftOut || spec.otherwise !== undefined);
    const value = isLeftOut ? undefined : input.valueAsNumber;
    input.blur(); // so that the keys play and pause again
    if (isGood) return this.apply(value);
    const kind = spec.isWhole ? 'whole number' : 'number';
    this.refuse(`The value must be a ${kind} from ${spec.min} to ${spec.max}.`);
  }

  private async apply(value: number | undefined): Promise<void> {
    const fault = await this.set(value);
    if (fault !== undefined) return this.refuse(fault);
    this.fault.hidden = true;
  }

  /** It is as it was, and that is said. */
  private refuse(words: string): void {
    this.input.value = this.text;
    this.fault.textContent = words;
    this.fault.hidden = false;
  }
}
