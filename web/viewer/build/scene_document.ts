import type { Scene } from '../../client/index';
import type { Request } from '../stream/stream';

/** The scene that the session runs, with what commands have made of it; asked for once it is needed. */
export class SceneDocument {
  private asked: Promise<Scene | undefined> | undefined;

  constructor(private readonly request: Request) {}

  /** The session has another scene, or other bodies. */
  forget(): void {
    this.asked = undefined;
  }

  /**
   * Undefined where the server does not give it: one that is older than this page, a scene that is
   * larger than a message, a line that is down.
   */
  get(): Promise<Scene | undefined> {
    this.asked ??= this.request('scene.get', { current: true }).then(
      ({ scene }) => scene,
      () => undefined,
    );
    return this.asked;
  }
}
