import { afterAll, afterEach, beforeAll, expect } from 'vitest';
import type { Scene } from '../../../web/client/index';
import { Observer } from './observer';
import type { Host } from './server';
import { sketchOf } from './pixels';
import { openPage, sharedServer } from './shared';
import type { Look, Viewer } from './viewer';

/** Limit and period of polls. */
export const kInTime = { timeout: 120_000, interval: 50 };

/** A phone in portrait orientation. */
export const kPhone: Look = {
  viewport: { width: 390, height: 800 },
  hasTouch: true,
  isMobile: true,
};

/** The layout of one pixel per point, with a quarter of the pixels. */
const kCoarse: Look = { deviceScaleFactor: 0.5 };

/** The scene between two visits, so that the page restarts with the next. */
const kNothing: Scene = { format: 'vat.scene/1', name: 'nothing', materials: [], bodies: [] };

/** The page of the last file, which the next file uses if it needs the same kind of device. */
let spare: { page: Viewer; device: string } | undefined;

type Visit = Look & {
  tick?: number;
  /** Settings of the view, in the form of links. */
  view?: string;
};

/**
 * A server for the tests of a file, a second client in its first session, and one page. `visit`
 * loads scenes in the page. The page is replaced if a visit needs another kind of device, and after
 * a failed test. Files with the shared server also share the page. A test fails if the page had a
 * problem.
 */
export class Visits {
  private client: Observer | undefined;
  private page: Viewer | undefined;
  private device = '';

  constructor(readonly server: Host = sharedServer) {
    beforeAll(async () => {
      await server.start();
      this.client = await Observer.join(server.url);
    });
    afterEach(async ({ task }) => {
      const problems = this.page?.problems.splice(0) ?? [];
      const isGone = this.page && new URL(this.page.page.url()).search !== '';
      if (this.page && task.result?.state === 'fail')
        process.stderr.write(`${await sketchOf(this.page)}\n`);
      if (task.result?.state === 'fail' || problems.length > 0 || isGone) await this.leave();
      expect(problems).toEqual([]);
    });
    afterAll(async () => {
      await this.handOver();
      this.client?.leave();
      await server.kill();
    });
  }

  get observer(): Observer {
    if (!this.client) throw new Error('the server has not been started');
    return this.client;
  }

  get isOpen(): boolean {
    return this.page !== undefined;
  }

  get viewer(): Viewer {
    if (!this.page) throw new Error('this test has visited no scene');
    return this.page;
  }

  /** Shows a scene that is paused at this tick. */
  async visit(scene: string | Scene, { tick = 0, view = '', ...look }: Visit = {}): Promise<void> {
    const { observer } = this;
    const name = typeof scene === 'string' ? scene : scene.name!;
    await observer.request('control.pause', {}); // also for later scenes
    await observer.request('scene.load', { scene: kNothing });
    await this.open(look);
    await this.viewer.untilScene('nothing');
    await this.viewer.page.evaluate(closeAll);
    await this.set(view);
    await observer.request('control.set_speed', { speed: 1 });
    await observer.request('scene.load', { scene });
    // The camera frames the first state that the page shows.
    await this.viewer.untilScene(name);
    await this.viewer.untilTick(0, 0);
    if (tick > 0) await observer.request('control.step', { ticks: tick });
    await this.viewer.untilTick(tick, tick);
    await this.untilWhole();
  }

  /** Waits for full detail, which a slow page requests while the session is paused. */
  async untilWhole(): Promise<void> {
    await this.viewer.until('#connection[data-slow="false"]');
  }

  /** Sets these view settings and resets the others to their defaults. */
  async set(view: string): Promise<void> {
    await this.viewer.setView(view);
  }

  /** Returns the present scene. */
  async scene(): Promise<Scene> {
    return (await this.observer.request('scene.get', { current: true })).scene;
  }

  private async open({ colorScheme = 'light', ...look }: Look): Promise<void> {
    const device = { ...kCoarse, ...look };
    const name = JSON.stringify({ ...device, before: String(look.before) });
    if (!this.page && this.server === sharedServer) await this.takeOver(name);
    if (!this.page || this.device !== name) {
      await this.leave();
      this.device = name;
      this.page = await openPage(this.server.url, device);
    }
    await this.page.page.emulateMedia({ colorScheme });
  }

  /** Uses the spare page if it is of this kind. Otherwise closes it, because it would draw too. */
  private async takeOver(device: string): Promise<void> {
    if (spare?.device === device) this.page = spare.page;
    else await spare?.page.close();
    this.device = device;
    spare = undefined;
  }

  private async handOver(): Promise<void> {
    if (!this.page || this.server !== sharedServer) return this.leave();
    await this.observer.request('control.pause', {});
    spare = { page: this.page, device: this.device };
    this.page = undefined;
  }

  private async leave(): Promise<void> {
    await this.page?.close();
    this.page = undefined;
  }
}

/** Opens only one section of the panel. On a phone, opens the sheet with the sections first. */
export async function unfold({ page }: Viewer, id: string): Promise<void> {
  await page.evaluate((open) => {
    const sheet = document.getElementById('sheet')!;
    if (sheet.checkVisibility() && sheet.ariaExpanded === 'false') sheet.click();
    const sections = document.querySelectorAll<HTMLDetailsElement>('#sections > details[id]');
    for (const section of sections) {
      section.open = section.id === open;
    }
  }, id);
}

/** Waits until the element with this id is visible and contains these words. */
export async function says({ page }: Viewer, id: string, words: string): Promise<void> {
  await page.waitForFunction(
    ([where, what]) => {
      const element = document.getElementById(where);
      return element?.checkVisibility() && element.textContent?.includes(what);
    },
    [id, words] as const,
  );
}

/** Runs in the browser: restores the initial state of the page. */
function closeAll(): void {
  for (const dialog of document.querySelectorAll('dialog')) dialog.close();
  document.getElementById('notices')!.replaceChildren();
  document.getElementById('camera-menu')!.hidePopover();
  document.getElementById('tool-grab')!.click();
  const sheet = document.getElementById('sheet')!;
  const isPhone = matchMedia('(max-width: 760px)').matches;
  if (isPhone && sheet.ariaExpanded === 'true') sheet.click();
  for (const section of document.querySelectorAll<HTMLDetailsElement>('#sections > details[id]')) {
    section.open = section.id === 'numbers-details';
  }
  (document.activeElement as HTMLElement | null)?.blur();
}
