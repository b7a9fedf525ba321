import type { MaterialDescription, Scene, SceneMaterial } from '../../../client/index';
import { make } from '../../panel/elements';
import { AppearanceForm } from './appearance_form';
import { fieldsOf, valueAt, withValue } from './material_fields';
import type { Change, ParameterForm } from './parameter_form';
import { ValueField } from './value_field';

/** The form for the constants of materials in the running scene. */
export class MaterialForm implements ParameterForm {
  readonly element: HTMLElement;
  private readonly picker = make('select', { id: 'material', ariaLabel: 'Material' });
  private readonly rows = make('div');
  private readonly appearance = new AppearanceForm((make) => this.edit(make));
  private fields: ValueField[] = [];
  /** The material and constants of the displayed fields. */
  private shown = '';
  private materials: readonly SceneMaterial[] = [];
  private initial: readonly SceneMaterial[] = [];
  private isEnabled = false;
  private described: readonly MaterialDescription[] = [];

  constructor(private readonly change: Change<'world.set_material'>) {
    this.element = make(
      'div',
      {},
      make('h3', {}, 'Materials'),
      this.picker,
      this.rows,
      this.appearance.element,
    );
    this.picker.addEventListener('change', () => this.write());
  }

  enable(enabled: boolean): void {
    this.isEnabled = enabled;
    this.picker.disabled = !enabled;
    for (const field of this.fields) field.enable(enabled);
    this.appearance.enable(enabled);
  }

  /** Receives the appearances that are drawn. */
  describe(materials: readonly MaterialDescription[]): void {
    this.described = materials;
    this.write();
  }

  show(scene: Scene, initial: Scene): void {
    this.materials = scene.materials;
    this.initial = initial.materials;
    const chosen = this.picker.value;
    const names = scene.materials.map(({ name }) => name);
    this.picker.replaceChildren(...names.map((name) => new Option(name, name)));
    if (names.includes(chosen)) this.picker.value = chosen;
    this.write();
  }

  private get material(): SceneMaterial | undefined {
    return this.materials.find(({ name }) => name === this.picker.value);
  }

  private write(): void {
    const { material } = this;
    if (!material) return;
    const specs = fieldsOf(material);
    const key = JSON.stringify([material.name, specs.map(({ path }) => path)]);
    if (key !== this.shown) {
      this.shown = key;
      this.fields = specs.map(({ path, ...spec }) => {
        const id = `material-${path.join('-')}`;
        return new ValueField({ id, ...spec }, (value) => this.set(path, value));
      });
      this.rows.replaceChildren(...this.fields.map((field) => field.element));
    }
    const first = this.initial.find(({ name }) => name === material.name);
    specs.forEach(({ path }, i) => {
      this.fields[i]!.show(valueAt(material, path), first && valueAt(first, path));
    });
    const drawn = this.described.find(({ name }) => name === material.name);
    this.appearance.show(material, first, drawn?.appearance);
    this.enable(this.isEnabled);
  }

  private async set(
    path: readonly string[],
    value: number | undefined,
  ): Promise<string | undefined> {
    if (value === undefined) return undefined;
    return this.edit((material) => withValue(material, path, value));
  }

  /** Replaces the chosen material, which another choice does not change. */
  private edit(make: (material: SceneMaterial) => SceneMaterial): Promise<string | undefined> {
    const { value: chosen } = this.picker;
    return this.change(() => {
      const material = this.materials.find(({ name }) => name === chosen);
      return material && { material: make(material) };
    });
  }
}
