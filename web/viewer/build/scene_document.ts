import type { Scene } from '../../client/index';
import type { Request } from '../stream/stream';

/** The session's scene with all changes by commands. It is requested on demand. */
export class SceneDocument {
  private asked: Promise<Scene | undefined> | undefined;
  private askedAsLoaded: Promise<Scene | undefined> | undefined;

  constructor(private readonly request: Request) {}

  /** Discards the scene after a change of scene or bodies. */
  forget(): void {
    this.asked = undefined;
  }

  /** Discards both scenes: another scene or session, or an earlier time of the same. */
  restart(): void {
    this.forget();
    this.askedAsLoaded = undefined;
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

  /**
   * Returns the scene as it was loaded. If it is larger than a message, returns the scene at the
   * first request.
   */
  asLoaded(): Promise<Scene | undefined> {
    this.askedAsLoaded ??= this.request('scene.get', {}).then(
      ({ scene }) => scene,
      () => this.get(),
    );
    return this.askedAsLoaded;
  }
}
