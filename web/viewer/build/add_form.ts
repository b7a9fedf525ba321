import type { BodyKindName, Scene } from '../../client/index';
import { make, makeButton } from '../panel/elements';
import { formatCount } from '../panel/format';
import { materialsFor, particlesOf } from './body_choice';
import type { BodyChoice } from './body_choice';
import { readMesh } from './mesh_file';
import type { MeshShape } from './mesh_file';
import { withNewMaterials } from './new_materials';

const kKinds: Readonly<Record<BodyKindName, string>> = {
  rigid: 'rigid',
  deformable: 'soft',
  liquid: 'liquid',
};

const kShapes: Readonly<Record<BodyChoice['shape'], string>> = {
  sphere: 'ball',
  box: 'box',
  mesh: 'shape from a file …',
};

/** The form for a new body: kind, shape, material and size. */
export class AddForm {
  readonly element: HTMLElement;
  private readonly kind = picker('add-kind', 'Kind', kKinds);
  private readonly shape = picker('add-shape', 'Shape', kShapes);
  private readonly material = make('select', { id: 'add-material', ariaLabel: 'Material' });
  private readonly size = make('input', {
    id: 'add-size',
    type: 'range',
    min: '0.04',
    max: '0.6',
    step: '0.01',
    value: '0.2',
  });
  private readonly sizeText = make('output');
  private readonly note = make('p', { id: 'add-note', className: 'soft' });
  private readonly file = make('input', { id: 'add-file', type: 'file', accept: '.obj,.stl' });
  private readonly placeButton: HTMLButtonElement;
  private mesh: MeshShape | undefined;
  /** The scene, including the materials that can be added. */
  private scene: Scene | undefined;
  /** Names of the materials that the scene has. */
  private known: ReadonlySet<string> = new Set();
  private isEnabled = false;

  constructor(
    place: (choice: BodyChoice) => void,
    private readonly fail: (words: string) => void,
  ) {
    this.file.hidden = true;
    this.placeButton = makeButton('Place it in the view', () => {
      const { choice } = this;
      if (choice) place(choice);
    });
    this.placeButton.id = 'add-place';
    const sizeLabel = make('label', { htmlFor: 'add-size' }, 'Size');
    this.element = make(
      'div',
      { className: 'build-form' },
      make('div', { className: 'row' }, this.kind, this.shape),
      make('div', { className: 'row' }, this.material),
      make('div', { className: 'row' }, sizeLabel, this.size, this.sizeText),
      this.note,
      make('div', { className: 'row' }, this.placeButton),
      this.file,
    );
    this.kind.addEventListener('change', () => this.show());
    this.material.addEventListener('change', () => this.write());
    this.size.addEventListener('input', () => this.write());
    this.shape.addEventListener('change', () => {
      if (this.shape.value === 'mesh') this.file.click();
      this.write();
    });
    this.file.addEventListener('change', () => void this.read(this.file.files?.[0]));
    this.show();
  }

  enable(enabled: boolean): void {
    this.isEnabled = enabled;
    for (const control of [this.kind, this.shape, this.material, this.size]) {
      control.disabled = !enabled;
    }
    this.write();
  }

  describe(scene: Scene | undefined): void {
    this.scene = scene && withNewMaterials(scene);
    this.known = new Set(scene?.materials.map(({ name }) => name));
    this.show();
  }

  /** Undefined if the scene is unknown or no file is chosen. */
  private get choice(): BodyChoice | undefined {
    const shape = this.shape.value as BodyChoice['shape'];
    if (!this.material.value || (shape === 'mesh' && !this.mesh)) return undefined;
    return {
      kind: this.kind.value as BodyKindName,
      shape,
      material: this.material.value,
      size: this.size.valueAsNumber,
      ...(shape === 'mesh' && this.mesh && { mesh: this.mesh }),
    };
  }

  private show(): void {
    const chosen = this.material.value;
    const kind = this.kind.value as BodyKindName;
    const names = this.scene ? materialsFor(this.scene, kind).map(({ name }) => name) : [];
    const words = (name: string): string => (this.known.has(name) ? name : `${name} (new)`);
    this.material.replaceChildren(...names.map((name) => new Option(words(name), name)));
    if (names.includes(chosen)) this.material.value = chosen;
    this.write();
  }

  private write(): void {
    const { choice, scene } = this;
    this.sizeText.value = `${Math.round(100 * this.size.valueAsNumber)} cm`;
    this.placeButton.disabled = !this.isEnabled || !choice;
    if (choice && scene) {
      this.note.textContent = `About ${formatCount(particlesOf(scene, choice))} particles.`;
    } else if (this.shape.value === 'mesh' && this.material.value) {
      this.note.textContent = 'Choose an .obj or .stl file.';
    } else this.note.textContent = '';
  }

  private async read(file: File | undefined): Promise<void> {
    this.file.value = ''; // allows the same file to be chosen again
    if (!file) return;
    const read = await readMesh(file);
    if ('fault' in read) {
      this.fail(read.fault);
      this.shape.value = 'sphere';
    } else this.mesh = read;
    this.write();
  }
}

function picker(
  id: string,
  label: string,
  words: Readonly<Record<string, string>>,
): HTMLSelectElement {
  const made = make('select', { id, ariaLabel: label });
  for (const [value, text] of Object.entries(words)) made.add(new Option(text, value));
  return made;
}
