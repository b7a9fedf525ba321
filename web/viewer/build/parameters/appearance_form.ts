import type { Appearance, SceneMaterial } from '../../../client/index';
import { make, makeButton } from '../../panel/elements';
import {
  kAbsorptionField,
  kAppearanceFields,
  kFinishes,
  withAppearance,
  withAppearanceOf,
} from './appearance_fields';
import type { AppearanceField, AppearanceName } from './appearance_fields';
import { ValueField } from './value_field';

/** The value of the option for a finish that follows the name of the material. */
const kAutomatic = '';

/** The form for colour and surface of a material. */
export class AppearanceForm {
  readonly element: HTMLElement;
  private readonly colour = make('input', { id: 'appearance-colour', type: 'color' });
  private readonly finish = make('select', { id: 'appearance-finish' });
  /** Only for solids. */
  private readonly finishRow: HTMLElement;
  private readonly reset: HTMLButtonElement;
  private readonly fault = make('p', { className: 'fault', role: 'alert', hidden: true });
  private readonly fields: readonly (AppearanceField & { input: ValueField })[];
  private initial: SceneMaterial | undefined;

  /** `set` replaces the material. It returns an error text if the server rejects it. */
  constructor(
    private readonly set: (
      make: (material: SceneMaterial) => SceneMaterial,
    ) => Promise<string | undefined>,
  ) {
    this.fields = [...kAppearanceFields, kAbsorptionField].map((spec) => ({
      ...spec,
      input: new ValueField(spec, (value) => this.change(spec.name, value)),
    }));
    this.finish.add(new Option('automatic', kAutomatic));
    for (const [value, words] of Object.entries(kFinishes)) {
      this.finish.add(new Option(words, value));
    }
    this.colour.addEventListener('change', () => {
      void this.apply('colour', this.colour.value);
    });
    this.finish.addEventListener('change', () => {
      const chosen = this.finish.value as NonNullable<Appearance['finish']>;
      void this.apply('finish', this.finish.value === kAutomatic ? undefined : chosen);
    });
    this.reset = makeButton('Reset appearance', () => void this.goBack());
    this.reset.id = 'appearance-reset';
    const row = (label: string, control: HTMLElement): HTMLElement =>
      make('div', { className: 'row' }, make('label', { htmlFor: control.id }, label), control);
    this.finishRow = row('Finish', this.finish);
    this.element = make(
      'div',
      { className: 'build-form' },
      make('h3', {}, 'Appearance'),
      row('Colour', this.colour),
      this.finishRow,
      this.fault,
      ...this.fields.map(({ input }) => input.element),
      make('div', { className: 'row' }, this.reset),
    );
  }

  enable(enabled: boolean): void {
    for (const control of [this.colour, this.finish, this.reset]) control.disabled = !enabled;
    for (const { input } of this.fields) input.enable(enabled);
  }

  /** `initial` is the material of the loaded scene, `complete` the appearance that is drawn. */
  show(
    material: SceneMaterial,
    initial: SceneMaterial | undefined,
    complete: Appearance | undefined,
  ): void {
    this.initial = initial;
    const { appearance = {}, liquid } = material;
    const before = initial?.appearance ?? {};
    this.colour.value = (appearance.colour ?? complete?.colour ?? '#888888').toLowerCase();
    this.finishRow.hidden = liquid !== undefined;
    this.finish.value = appearance.finish ?? kAutomatic;
    this.finish.title = complete?.finish ? `Drawn as: ${kFinishes[complete.finish]}` : '';
    for (const { name, unit, input } of this.fields) {
      const drawn = complete?.[name];
      const isAutomatic = appearance[name] === undefined && drawn !== undefined;
      input.show(appearance[name], before[name], isAutomatic ? `${unit}; now ${drawn}` : unit);
      input.element.hidden = name === 'absorption_length' && !liquid;
    }
    this.reset.hidden = JSON.stringify(appearance) === JSON.stringify(before);
  }

  private change<N extends AppearanceName>(
    name: N,
    value: Appearance[N] | undefined,
  ): Promise<string | undefined> {
    return this.set((material) => withAppearance(material, name, value));
  }

  private async apply<N extends AppearanceName>(
    name: N,
    value: Appearance[N] | undefined,
  ): Promise<void> {
    this.say(await this.change(name, value));
  }

  private async goBack(): Promise<void> {
    const { initial } = this;
    this.say(await this.set((material) => withAppearanceOf(material, initial)));
  }

  private say(fault: string | undefined): void {
    this.fault.textContent = fault ?? '';
    this.fault.hidden = fault === undefined;
  }
}
