import type { SessionDescription } from '../../client/index';
import { addCameraKeys } from '../panel/camera_keys';
import { element } from '../panel/elements';
import type { Keys } from '../panel/keys';
import { now } from '../stream/clock';
import { isCalm } from '../view/base/calm';
import { kPresets } from '../view/base/presets';
import type { View } from '../view/view';
import type { CameraMenu } from './camera_menu';
import { CameraMotion } from './camera_motion';
import { IdleOrbit } from './idle_orbit';

/** The key of the first preset; the keys of the others follow. */
const kFirstKey = 4;

/** The page's state that the camera's menu shows. */
export interface Shown {
  bodies(): SessionDescription['bodies'];
  /** The scene's name and the simulated time [s]. */
  moment(): { scene: string; time: number };
  /** Returns the function that opens the dialog for links, if there is something to link to. */
  share(): (() => void) | undefined;
}

/** The camera's keys and menu, and its movements without the pointer. */
export class CameraControl {
  private readonly motion: CameraMotion;
  private readonly menuElement = element('camera-menu', HTMLElement);
  private menu: CameraMenu | undefined;

  constructor(
    private readonly view: View,
    private readonly keys: Keys,
    private readonly shown: Shown,
  ) {
    const { stage, world, settings } = view;
    const placeOf = (body: number) => world.centreOf(body);
    this.motion = new CameraMotion(stage, placeOf, new IdleOrbit(window, now), isCalm);
    stage.onMoved = () => this.motion.interrupt();
    settings.subscribe(({ orbit }) => (this.motion.orbits = orbit === 'on'));
    this.menuElement.addEventListener('beforetoggle', (event) => {
      if ((event as ToggleEvent).newState === 'open') void this.prepare();
    });
  }

  addKeys(): void {
    const { keys } = this;
    kPresets.forEach((preset, i) => {
      const key = String(kFirstKey + i);
      const act = (): void => this.motion.show(preset, now());
      keys.add({ keys: [key], sign: key, words: `view from the ${preset}`, act });
    });
    keys.add({
      keys: ['c'],
      sign: 'C',
      words: 'menu for camera, photo, video and link',
      act: () => this.menuElement.togglePopover(),
    });
    addCameraKeys(keys, this.view.stage, () => this.home());
  }

  /** `isNew`: another scene or session. */
  describe({ bodies }: SessionDescription, isNew: boolean): void {
    const { body } = this.motion;
    if (isNew || !bodies.some((one) => one.body === body)) this.follow(undefined);
  }

  /** Moves the camera. Called once per animation frame, before the picture is drawn. */
  update(time: number): void {
    this.motion.update(time);
  }

  private home(): void {
    const { stage, world } = this.view;
    this.follow(undefined);
    stage.reframe();
    stage.follow(world.framed, world.bounds);
  }

  private follow(body: number | undefined): void {
    this.motion.follow(body);
    this.view.stage.canvas.dataset.followed = String(body ?? '');
  }

  /** Loads the menu when it opens for the first time. */
  private async prepare(): Promise<void> {
    if (!this.menu) {
      const { CameraMenu } = await import('./camera_menu');
      this.menu ??= this.made(CameraMenu);
    }
    this.menu.refresh();
  }

  private made(Menu: typeof CameraMenu): CameraMenu {
    const { motion, shown, view } = this;
    return new Menu(this.menuElement, {
      stage: view.stage,
      show: (preset) => motion.show(preset, now()),
      follow: (body) => this.follow(body),
      get followed() {
        return motion.body;
      },
      get bodies() {
        return shown.bodies();
      },
      get moment() {
        return shown.moment();
      },
      get share() {
        return shown.share();
      },
    });
  }
}
