import { make, makeButton } from '../../panel/elements';

/** An editable number with its unit and range. */
export interface ValueSpec {
  id: string;
  label: string;
  unit: string;
  min: number;
  max: number;
  isWhole?: boolean;
  /** The text for an absent number; undefined if the number is required. */
  otherwise?: string;
}

/** Sets the value. Returns an error text, or undefined after success. */
export type SetValue = (value: number | undefined) => Promise<string | undefined>;

/** A number field: label, unit, range, reset, and an error text below. */
export class ValueField {
  readonly element: HTMLElement;
  private readonly input: HTMLInputElement;
  private readonly reset: HTMLButtonElement;
  private readonly unit = make('small');
  private readonly fault = make('p', { className: 'fault', role: 'alert', hidden: true });
  private initial: number | undefined;
  private value: number | undefined;
  private edits = 0; // the reply to an earlier edit does not change the error of a later one

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

  /** `initial` is the value of the loaded scene. `unit` replaces the unit's text. */
  show(value: number | undefined, initial: number | undefined, unit = this.spec.unit): void {
    this.value = value;
    this.initial = initial;
    this.unit.textContent = unit;
    // A text that is being edited does not change.
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
    input.blur(); // returns the keys to the page
    if (isGood) return this.apply(value);
    const kind = spec.isWhole ? 'whole number' : 'number';
    this.refuse(`The value must be a ${kind} from ${spec.min} to ${spec.max}.`);
  }

  private async apply(value: number | undefined): Promise<void> {
    const edit = ++this.edits;
    const fault = await this.set(value);
    if (edit !== this.edits) return;
    if (fault !== undefined) return this.refuse(fault);
    this.fault.hidden = true;
  }

  /** Restores the value and displays the error. */
  private refuse(words: string): void {
    ++this.edits;
    this.input.value = this.text;
    this.fault.textContent = words;
    this.fault.hidden = false;
  }
}
