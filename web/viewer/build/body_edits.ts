import type { SceneBody, SceneInterface, SceneMaterial, Vector } from '../../client/index';
import { ask } from '../stream/desk';
import type { Desk } from '../stream/desk';
import { inWorld } from './body_choice';
import { mean, recordOf } from './body_record';
import type { BodyRecord } from './body_record';
import type { Edits } from './edits';
import type { SceneDocument } from './scene_document';

/** A body that is there: its id changes where it is removed and added again. */
interface Living {
  id: number;
}

/** A material that the scene has not, and how it meets others where that is not as usual. */
export interface FreshMaterial {
  material: SceneMaterial;
  interfaces: readonly SceneInterface[];
}

/** Adds, removes and remakes bodies, each so that it can be undone. */
export class BodyEdits {
  constructor(
    private readonly desk: Desk,
    private readonly document: SceneDocument,
    private readonly edits: Edits,
  ) {}

  /** With a material that the scene has not, if there is one: it stays where this is undone. */
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

  /** To where its centre of mass is to be; it rests there. */
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

  /** The body is made anew as it is, of another material. */
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
      await this.put(before, living); // as it was
      return;
    }
    this.edits.add({
      words: `made ${name} of ${material}`,
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

  /** As it is now; undefined where the scene does not tell how it was made. */
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
