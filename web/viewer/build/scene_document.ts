import type { Scene } from '../../client/index';
import type { Request } from '../stream/stream';

/** The session's scene with all changes by commands. It is requested on demand. */
export class SceneDocument {
  private asked: Promise<Scene | undefined> | undefined;

  constructor(private readonly request: Request) {}

  /** Discards the scene after a change of scene or bodies. */
  forget(): void {
    this.asked = undefined;
  }

  /**
   * Returns the scene. Undefined if the server is older than the page, if the scene is larger than a
   * message, or without a connection.
   */
  get(): Promise<Scene | undefined> {
    this.asked ??= this.request('scene.get', { current: true }).then(
      ({ scene }) => scene,
      () => undefined,
    );
    return this.asked;
  }
}
