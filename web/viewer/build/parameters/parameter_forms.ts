import type { MethodName, SessionDescription } from '../../../client/index';
import { element } from '../../panel/elements';
import { attempt } from '../../panel/desk';
import type { Desk } from '../../panel/desk';
import { InterfaceForm } from './interface_form';
import { MaterialForm } from './material_form';
import { NumericsForm } from './numerics_form';
import type { Change, ParameterForm } from './parameter_form';
import type { SceneDocument } from '../scene_document';

/** The forms for materials, interfaces and steps, with units, ranges and reset. */
export class ParameterForms {
  private readonly section = element('parameters-details', HTMLDetailsElement);
  private readonly materials = new MaterialForm((make) => this.change('world.set_material', make));
  private readonly forms: readonly ParameterForm[];
  private isEnabled = false;
  /** The forms show the present scene. */
  private isShown = false;
  /** Counts the scenes, and the returns to earlier times. */
  private age = 0;
  /** Ends with the last change. */
  private last: Promise<unknown> = Promise.resolve();

  constructor(
    private readonly desk: Desk,
    private readonly document: SceneDocument,
  ) {
    this.forms = [
      this.materials,
      new InterfaceForm((make) => this.change('world.set_interface', make)),
      new NumericsForm((make) => this.change('world.set_numerics', make)),
    ];
    element('forms-place', HTMLElement).append(...this.forms.map((form) => form.element));
    this.section.addEventListener('toggle', () => void this.look());
  }

  enable(enabled: boolean): void {
    this.isEnabled = enabled;
    this.enableForms();
  }

  /** `isNew`: another scene or session, or an earlier time of the same. */
  describe(description: SessionDescription, isNew: boolean): void {
    if (isNew) {
      this.document.restart();
      ++this.age;
      this.isShown = false;
      this.enableForms();
    }
    this.materials.describe(description.materials);
    void this.look();
  }

  /** Requests the scene if the section is open. */
  private async look(): Promise<void> {
    if (!this.section.open || !this.isEnabled) return;
    const { age } = this;
    const [scene, initial] = await Promise.all([this.document.get(), this.document.asLoaded()]);
    if (!scene || !initial || age !== this.age) return;
    for (const form of this.forms) form.show(scene, initial);
    this.isShown = true;
    this.enableForms();
  }

  /** The constants of another scene cannot be changed. */
  private enableForms(): void {
    for (const form of this.forms) form.enable(this.isEnabled && this.isShown);
  }

  /** A change of one constant contains the other constants of its material or interface. */
  private change<M extends MethodName>(
    method: M,
    make: Parameters<Change<M>>[0],
  ): ReturnType<Change<M>> {
    const { age } = this;
    const done = this.last.then(async () => {
      const params = age === this.age ? make() : undefined;
      if (!params) return undefined;
      const fault = await attempt(this.desk, method, params);
      this.document.forget();
      await this.look();
      return fault;
    });
    this.last = done.catch(() => undefined); // the caller gets the error
    return done;
  }
}
