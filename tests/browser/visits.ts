import { afterAll, afterEach, beforeAll, expect } from 'vitest';
import type { Scene } from '../../web/client/index';
import { Observer } from './observer';
import { Server } from './server';
import { Viewer } from './viewer';
import type { Look } from './viewer';

/** A phone, held upright. */
export const kPhone: Look = {
  viewport: { width: 390, height: 800 },
  hasTouch: true,
  isMobile: true,
};

type Visit = Look & { tick?: number; hash?: string };

/**
 * A server for the tests of a file, a second client in its session, and the page, which each test
 * opens by `visit` and which must have had no problem when the test ends.
 */
export class Visits {
  private client: Observer | undefined;
  private page: Viewer | undefined;

  constructor(readonly server = new Server()) {
    beforeAll(async () => {
      await server.start();
      this.client = await Observer.join(server.url);
    });
    afterEach(async () => {
      const problems = this.page?.problems ?? [];
      await this.page?.close();
      this.page = undefined;
      expect(problems).toEqual([]);
    });
    afterAll(async () => {
      this.client?.leave();
      await server.kill();
    });
  }

  get observer(): Observer {
    if (!this.client) throw new Error('the server has not been started');
    return this.client;
  }

  get viewer(): Viewer {
    if (!this.page) throw new Error('this test has visited no scene');
    return this.page;
  }

  /** Opens the page on a scene that stands still at this tick; the address ends in `hash`. */
  async visit(scene: string, { tick = 0, hash = '', ...look }: Visit = {}): Promise<void> {
    await this.observer.request('scene.load', { scene });
    await this.observer.request('control.pause', {});
    await this.observer.request('control.reset', {});
    if (tick > 0) await this.observer.request('control.step', { ticks: tick });
    this.page = await Viewer.open(this.server.url + hash, look);
    await this.page.untilScene(scene);
    await this.page.untilTick(tick, tick);
  }

  /** The scene as it is now. */
  async scene(): Promise<Scene> {
    return (await this.observer.request('scene.get', { current: true })).scene;
  }
}
