import type { Scene, SceneInterface } from '../../../client/index';
import { make, makeButton } from '../../panel/elements';
import {
  fieldsOf,
  interfaceOf,
  kLaws,
  kVat,
  ownInterface,
  valueOf,
  withConstant,
  withLaw,
} from './interface_fields';
import type { Law } from './interface_fields';
import type { ParameterForm, Change } from './parameter_form';
import { ValueField } from './value_field';

/** The form for the interface of two materials in the running scene. */
export class InterfaceForm implements ParameterForm {
  readonly element: HTMLElement;
  private readonly first = make('select', { id: 'contact-first', ariaLabel: 'One material' });
  private readonly second = make('select', { id: 'contact-second', ariaLabel: 'The other' });
  private readonly law = make('select', { id: 'contact-law' });
  private readonly note = make('p', { id: 'contact-note', className: 'soft' });
  private readonly fault = make('p', { className: 'fault', role: 'alert', hidden: true });
  private readonly rows = make('div');
  private readonly reset: HTMLButtonElement;
  private fields: ValueField[] = [];
  /** The pair and law of the displayed fields. */
  private shown = '';
  private scene: Scene | undefined;
  private initial: Scene | undefined;
  private isEnabled = false;

  constructor(private readonly change: Change<'world.set_interface'>) {
    for (const [value, words] of Object.entries(kLaws)) this.law.add(new Option(words, value));
    this.reset = makeButton('Reset all', () => void this.goBack());
    this.reset.id = 'contact-reset';
    for (const picker of [this.first, this.second]) {
      picker.addEventListener('change', () => this.write());
    }
    this.law.addEventListener('change', () => void this.setLaw(this.law.value as Law));
    const label = make('label', { htmlFor: 'contact-law' }, 'Law');
    this.element = make(
      'div',
      { className: 'build-form' },
      make('h3', {}, 'Interface'),
      make('div', { className: 'row' }, this.first, this.second),
      make('div', { className: 'row' }, label, this.law),
      this.fault,
      this.rows,
      this.note,
      make('div', { className: 'row' }, this.reset),
    );
  }

  enable(enabled: boolean): void {
    this.isEnabled = enabled;
    for (const control of [this.first, this.second, this.law, this.reset]) {
      control.disabled = !enabled;
    }
    for (const field of this.fields) field.enable(enabled);
  }

  show(scene: Scene, initial: Scene): void {
    this.scene = scene;
    this.initial = initial;
    const names = scene.materials.map(({ name }) => name);
    fill(this.first, names);
    fill(this.second, [kVat, ...names]);
    this.write();
  }

  private get pair(): [string, string] {
    return [this.first.value, this.second.value];
  }

  private write(): void {
    const { scene, initial, pair } = this;
    if (!scene || !initial || !pair[0]) return;
    const now = interfaceOf(scene, pair);
    const first = initialOf(initial, pair);
    const { law = 'penalty' } = now;
    this.law.value = law;
    const specs = fieldsOf(scene, now);
    const key = JSON.stringify([pair, specs.map(({ name }) => name)]);
    if (key !== this.shown) {
      this.shown = key;
      this.fault.hidden = true;
      this.fields = specs.map(
        (spec) => new ValueField(spec, (value) => this.setConstant(spec.name, value)),
      );
      this.rows.replaceChildren(...this.fields.map(({ element }) => element));
    }
    const isSameLaw = first !== undefined && (first.law ?? 'penalty') === law;
    specs.forEach(({ name, usual }, i) => {
      const before = isSameLaw ? (valueOf(first, name) ?? usual) : undefined;
      this.fields[i]!.show(valueOf(now, name) ?? usual, before);
    });
    this.note.textContent = noteOf(scene, pair, now);
    this.reset.hidden = !first || isAlike(scene, first, now);
    this.enable(this.isEnabled);
  }

  private setConstant(name: string, value: number | undefined): Promise<string | undefined> {
    return this.set((now) => withConstant(now, name, value));
  }

  private async setLaw(law: Law): Promise<void> {
    const { scene } = this;
    if (scene) this.say(await this.set((now) => withLaw(scene, now, law)));
  }

  private async goBack(): Promise<void> {
    const first = this.initial && initialOf(this.initial, this.pair);
    if (first) this.say(await this.set(() => first));
  }

  private set(make: (now: SceneInterface) => SceneInterface): Promise<string | undefined> {
    const { pair } = this;
    return this.change(() => this.scene && { interface: make(interfaceOf(this.scene, pair)) });
  }

  private say(fault: string | undefined): void {
    this.fault.textContent = fault ?? '';
    this.fault.hidden = fault === undefined;
    this.write();
  }
}

/** Returns the interface in the loaded scene; undefined for materials added later. */
function initialOf(initial: Scene, pair: [string, string]): SceneInterface | undefined {
  const isKnown = (name: string): boolean =>
    name === kVat || initial.materials.some((material) => material.name === name);
  return pair.every(isKnown) ? interfaceOf(initial, pair) : undefined;
}

function isAlike(scene: Scene, a: SceneInterface, b: SceneInterface): boolean {
  const constants = (one: SceneInterface): string =>
    JSON.stringify(
      fieldsOf(scene, one).map(({ name, usual }) => [name, valueOf(one, name) ?? usual]),
    );
  return (a.law ?? 'penalty') === (b.law ?? 'penalty') && constants(a) === constants(b);
}

function noteOf(scene: Scene, [a, b]: [string, string], now: SceneInterface): string {
  const isLiquid = (name: string): boolean =>
    scene.materials.some((material) => material.name === name && material.liquid);
  if (a === b && isLiquid(a)) return 'Bodies of one liquid have no interface.';
  if (ownInterface(scene, [a, b])) return '';
  return now.law === 'sph' ? 'The default of liquids in this scene.' : 'The default of this scene.';
}

/** Replaces the options. Keeps the selection if it still exists. */
function fill(picker: HTMLSelectElement, names: readonly string[]): void {
  const chosen = picker.value;
  const words = (name: string): string => (name === kVat ? 'the vat’s walls' : name);
  picker.replaceChildren(...names.map((name) => new Option(words(name), name)));
  if (names.includes(chosen)) picker.value = chosen;
}
