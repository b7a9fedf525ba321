import type { SceneBody, SceneInterface, SceneMaterial, Vector } from '../../client/index';
import { ask } from '../panel/desk';
import type { Desk } from '../panel/desk';
import { inWorld } from './body_choice';
import { mean, recordOf } from './body_record';
import type { BodyRecord } from './body_record';
import type { Edits } from './edits';
import type { SceneDocument } from './scene_document';

/** An existing body. Its id changes if it is removed and added again. */
interface Living {
  id: number;
}

/** A new material of the scene, and its interfaces that differ from the default. */
export interface FreshMaterial {
  material: SceneMaterial;
  interfaces: readonly SceneInterface[];
}

/** Adds, moves, removes and remakes bodies. Each edit can be undone. */
export class BodyEdits {
  constructor(
    private readonly desk: Desk,
    private readonly document: SceneDocument,
    private readonly edits: Edits,
  ) {}

  /** Adds a body, and its material if it is new. Undo does not remove the material. */
  async add(body: SceneBody, fresh?: FreshMaterial): Promise<void> {
    const living: Living = { id: 0 };
    if (fresh && !(await this.bring(fresh))) return;
    if (!(await this.put({ body }, living))) return;
    this.edits.add({
      words: `added ${body.name}`,
      undo: () => this.take(living),
      redo: () => this.put({ body }, living),
    });
  }

  async remove(id: number, name: string): Promise<void> {
    const record = await this.record(id, name);
    const living: Living = { id };
    if (!(await this.take(living)) || !record) return;
    this.edits.add({
      words: `deleted ${name}`,
      undo: () => this.put(record, living),
      redo: () => this.take(living),
    });
  }

  /** Moves a body's centre of mass to a position. The body is then at rest. */
  async move(body: number, name: string, position: Vector): Promise<void> {
    const state = await ask(this.desk, 'state.query', { bodies: [body] });
    const [now] = state?.bodies ?? [];
    if (!now) return;
    const before = now.center_of_mass ?? mean(now.positions);
    const scene = await this.document.get();
    const target = scene ? inWorld(scene, position) : position;
    const put = async (place: Vector): Promise<boolean> => {
      const params = { body, position: place, velocity: [0, 0, 0] as Vector };
      return (await ask(this.desk, 'world.move_body', params)) !== undefined;
    };
    if (!(await put(target))) return;
    this.edits.add({
      words: `moved ${name}`,
      undo: () => put(before),
      redo: () => put(target),
    });
  }

  /** Replaces the body by one of another material, with the same shape and motion. */
  async remake(id: number, name: string, material: string): Promise<void> {
    const before = await this.record(id, name);
    if (!before) {
      return this.desk.fail(`The scene does not contain the shape of “${name}”.`);
    }
    const after: BodyRecord = { ...before, body: { ...before.body, material } };
    const living: Living = { id };
    const swap = async (to: BodyRecord): Promise<boolean> =>
      (await this.take(living)) && (await this.put(to, living));
    if (!(await swap(after))) {
      await this.put(before, living); // restores the body
      return;
    }
    this.edits.add({
      words: `changed the material of ${name} to ${material}`,
      undo: () => swap(before),
      redo: () => swap(after),
    });
  }

  private async bring({ material, interfaces }: FreshMaterial): Promise<boolean> {
    if (!(await ask(this.desk, 'world.set_material', { material }))) return false;
    for (const one of interfaces) {
      if (!(await ask(this.desk, 'world.set_interface', { interface: one }))) return false;
    }
    this.document.forget();
    return true;
  }

  private async put(record: BodyRecord, living: Living): Promise<boolean> {
    const added = await ask(this.desk, 'world.add_body', record);
    if (added) living.id = added.body;
    return added !== undefined;
  }

  private async take(living: Living): Promise<boolean> {
    const { id: body } = living;
    return (await ask(this.desk, 'world.remove_body', { body })) !== undefined;
  }

  /** Returns the body's record; undefined if the scene does not describe the body. */
  private async record(id: number, name: string): Promise<BodyRecord | undefined> {
    const scene = await this.document.get();
    const made = scene?.bodies.find((body) => body.name === name);
    const state = await ask(this.desk, 'state.query', { bodies: [id] });
    const [now] = state?.bodies ?? [];
    if (!scene || !made || !now) return undefined;
    const { record, isWhole } = recordOf(scene, made, now);
    if (!isWhole)
      this.desk.say(
        `“${name}” is too large to keep its deformation. It returns in its initial shape.`,
      );
    return record;
  }
}
