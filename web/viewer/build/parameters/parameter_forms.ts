import type { MethodName, Params, SessionDescription } from '../../../client/index';
import { element } from '../../panel/elements';
import { attempt } from '../../panel/desk';
import type { Desk } from '../../panel/desk';
import { InterfaceForm } from './interface_form';
import { MaterialForm } from './material_form';
import { NumericsForm } from './numerics_form';
import type { ParameterForm } from './parameter_form';
import type { SceneDocument } from '../scene_document';

/** The forms for materials, interfaces and steps, with units, ranges and reset. */
export class ParameterForms {
  private readonly section = element('parameters-details', HTMLDetailsElement);
  private readonly materials = new MaterialForm((params) =>
    this.change('world.set_material', params),
  );
  private readonly forms: readonly ParameterForm[];
  private isEnabled = false;

  constructor(
    private readonly desk: Desk,
    private readonly document: SceneDocument,
  ) {
    this.forms = [
      this.materials,
      new InterfaceForm((params) => this.change('world.set_interface', params)),
      new NumericsForm((params) => this.change('world.set_numerics', params)),
    ];
    element('forms-place', HTMLElement).append(...this.forms.map((form) => form.element));
    this.section.addEventListener('toggle', () => void this.look());
  }

  enable(enabled: boolean): void {
    this.isEnabled = enabled;
    for (const form of this.forms) form.enable(enabled);
  }

  /** `isNew`: another scene or session, or an earlier time of the same. */
  describe(description: SessionDescription, isNew: boolean): void {
    if (isNew) this.document.restart();
    this.materials.describe(description.materials);
    void this.look();
  }

  /** Requests the scene if the section is open. */
  private async look(): Promise<void> {
    if (!this.section.open || !this.isEnabled) return;
    const [scene, initial] = await Promise.all([this.document.get(), this.document.asLoaded()]);
    if (!scene || !initial) return;
    for (const form of this.forms) form.show(scene, initial);
  }

  private async change<M extends MethodName>(
    method: M,
    params: Params<M>,
  ): Promise<string | undefined> {
    const fault = await attempt(this.desk, method, params);
    this.document.forget();
    await this.look();
    return fault;
  }
}
