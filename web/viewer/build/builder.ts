import { Vector3 } from 'three';
import type { SessionDescription } from '../../client/index';
import { element, make, makeButton } from '../panel/elements';
import type { Keys } from '../panel/keys';
import type { Desk } from '../panel/desk';
import { ballOf, blockOf } from '../view/base/footprint';
import type { View } from '../view/view';
import type { World } from '../view/world';
import { AddForm } from './add_form';
import { BodyEdits } from './body_edits';
import { makeBody } from './body_choice';
import type { BodyChoice } from './body_choice';
import { BodyList } from './body_list';
import { Edits } from './edits';
import { newInterfaces, withNewMaterials } from './new_materials';
import { Placer } from './placer';
import type { SceneDocument } from './scene_document';
import { addPlacingKeys } from './placing_keys';
import './build.css';

/** The section for building a scene: bodies are added, moved, remade and deleted, with undo. */
export class Builder {
  private readonly section = element('build-details', HTMLDetailsElement);
  private readonly edits = new Edits(() => this.showEdits());
  private readonly undoButton = makeButton('Undo', () => void this.edits.undo());
  private readonly redoButton = makeButton('Redo', () => void this.edits.redo());
  private readonly bodyEdits: BodyEdits;
  private readonly world: World;
  private readonly form: AddForm;
  private readonly list: BodyList;
  private readonly placer: Placer;
  private readonly hint = make('p', { id: 'placing', role: 'status', hidden: true });
  private description: SessionDescription | undefined;
  private isEnabled = false;

  /** `placing` reports whether the pointer places a body, so that it does not grab others. */
  constructor(
    private readonly desk: Desk,
    private readonly document: SceneDocument,
    view: View,
    keys: Keys,
    private readonly placing: (isPlacing: boolean) => void,
  ) {
    this.world = view.world;
    this.bodyEdits = new BodyEdits(desk, document, this.edits);
    this.form = new AddForm(
      (choice) => this.place(choice),
      (words) => desk.fail(words),
    );
    this.list = new BodyList({
      remove: ({ body, name }) => void this.bodyEdits.remove(body, name),
      move: ({ body, name }) => this.move(body, name),
      remake: ({ body, name }, material) => void this.bodyEdits.remake(body, name, material),
    });
    this.placer = new Placer(
      view.stage,
      view.world,
      () => this.showPlacing(false),
      () => desk.say('The position is occupied. Choose a position where the body is blue.'),
    );
    this.undoButton.id = 'undo';
    this.redoButton.id = 'redo';
    const undoing = make('div', { className: 'row' }, this.undoButton, this.redoButton);
    const titles = ['Add', 'Bodies'].map((text) => make('h3', {}, text));
    const place = element('build-place', HTMLElement);
    place.append(titles[0]!, this.form.element, undoing, titles[1]!, this.list.element);
    element('stage', HTMLElement).append(this.hint);
    this.section.addEventListener('toggle', () => void this.look());
    addPlacingKeys(keys, this.placer, view);
    this.addUndoKeys();
    this.showEdits();
  }

  enable(enabled: boolean): void {
    this.isEnabled = enabled;
    this.form.enable(enabled);
    this.list.enable(enabled);
    if (!enabled) this.placer.end();
    this.showEdits();
  }

  /** `isNew`: another scene or session, or an earlier time of the same. */
  describe(description: SessionDescription, isNew: boolean): void {
    this.description = description;
    if (isNew) this.edits.clear();
    if (isNew) this.placer.end();
    void this.look();
  }

  /** Requests the scene if the section is open. */
  private async look(): Promise<void> {
    const { description } = this;
    if (!this.section.open || !description || description.replay) return;
    const scene = await this.document.get();
    if (description !== this.description) return;
    this.form.describe(scene);
    this.list.describe(description.bodies, scene);
  }

  private move(body: number, name: string): void {
    const footprint = this.world.footprintOf(body);
    if (!footprint) return;
    this.placer.begin({ shape: 'box', footprint, body }, ({ x, y, z }) => {
      void this.bodyEdits.move(body, name, [x, y, z]);
    });
    this.showPlacing(true);
  }

  private place(choice: BodyChoice): void {
    const { shape, mesh, size } = choice;
    const footprint = shape === 'box' ? blockOf(size) : ballOf(size / 2);
    const thing = { shape, footprint, ...(mesh && { mesh }) };
    this.placer.begin(thing, (place) => void this.add(choice, place));
    this.showPlacing(true);
  }

  private async add(choice: BodyChoice, { x, y, z }: Vector3): Promise<void> {
    const scene = await this.document.get();
    if (!scene) return this.desk.fail('The server does not report the materials of the scene.');
    const taken = new Set([
      ...scene.bodies.map(({ name }) => name),
      ...(this.description?.bodies ?? []).map(({ name }) => name),
    ]);
    const offered = withNewMaterials(scene);
    const isKnown = scene.materials.some(({ name }) => name === choice.material);
    const material = offered.materials.find(({ name }) => name === choice.material);
    const fresh =
      isKnown || !material ? undefined : { material, interfaces: newInterfaces(scene, material) };
    await this.bodyEdits.add(makeBody(offered, choice, [x, y, z], taken), fresh);
  }

  private showPlacing(isPlacing: boolean): void {
    this.placing(isPlacing);
    this.hint.hidden = !isPlacing;
    this.hint.textContent = isPlacing
      ? 'Click the position, or move the body with the arrow keys and press Enter. Esc cancels.'
      : '';
    if (isPlacing) element('view', HTMLCanvasElement).focus();
  }

  private showEdits(): void {
    const { edits, undoButton, redoButton } = this;
    undoButton.disabled = !this.isEnabled || edits.toUndo === undefined;
    redoButton.disabled = !this.isEnabled || edits.toRedo === undefined;
    undoButton.title = edits.toUndo === undefined ? '' : `Undo: ${edits.toUndo} (Ctrl+Z)`;
    redoButton.title = edits.toRedo === undefined ? '' : `Redo: ${edits.toRedo} (Ctrl+Y)`;
  }

  /** Adds the usual key combinations. All other keys of the page have no modifiers. */
  private addUndoKeys(): void {
    window.addEventListener('keydown', (event) => {
      const key = event.key.toLowerCase();
      const isText = event.target instanceof HTMLInputElement && event.target.type === 'text';
      if (!(event.ctrlKey || event.metaKey) || isText || !this.isEnabled) return;
      const isRedo = key === 'y' || (key === 'z' && event.shiftKey);
      if (key !== 'z' && !isRedo) return;
      event.preventDefault();
      void (isRedo ? this.edits.redo() : this.edits.undo());
    });
  }
}
