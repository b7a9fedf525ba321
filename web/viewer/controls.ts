import type {
  Event,
  Level,
  SceneLevelsResult,
  SceneReference,
  SessionDescription,
} from '../client/index';
import { Builder } from './build/builder';
import { ParameterForms } from './build/parameters/parameter_forms';
import { Pour } from './build/pour';
import type { SceneDocument } from './build/scene_document';
import { VatPad } from './build/vat_pad';
import { Kept } from './kept/kept';
import { DeviceTilt } from './panel/gravity/device_tilt';
import { Gallery } from './panel/gallery';
import { Gravity } from './panel/gravity/gravity';
import type { Keys } from './panel/keys';
import { Playback } from './panel/playback';
import { SceneFile } from './panel/scene_file';
import { Levels } from './panel/levels';
import { Scenes } from './panel/scenes';
import { ReplayBar } from './replay/replay_bar';
import { ask } from './panel/desk';
import { leanInView } from './tools/tilt';
import { Tools } from './tools/tools';
import type { ToolSurroundings } from './tools/tools';
import type { Desk } from './panel/desk';
import type { Stream } from './stream/stream';
import type { View } from './view/view';

/** The page's functions that the controls use. */
export interface Surroundings extends ToolSurroundings {
  readonly document: SceneDocument;
  nameOfBody(body: number): string;
  /** Switches to another session; undefined: the server's first. */
  go(session: string | undefined): void;
  readonly stream: Pick<Stream, 'play' | 'loop'>;
  /** Shows the server's name in its cluster. */
  showNode(node: string | undefined): void;
}

/** The controls of the session: playback, scenes, saved items, parameters. */
export class Controls {
  private readonly playback: Playback;
  private readonly gallery = new Gallery((scene) => this.load(scene));
  private readonly scenes = new Scenes(this.gallery, (scene) => this.load(scene));
  private readonly levels = new Levels(
    (scene) => this.askLevels(scene),
    (scene, level) => this.load(scene, level),
  );
  private readonly sceneFile: SceneFile;
  private readonly gravity: Gravity;
  private readonly deviceTilt: DeviceTilt;
  private readonly tools: Tools;
  private readonly pour: Pour;
  private readonly builder: Builder;
  private readonly vatPad: VatPad;
  private readonly parameters: ParameterForms;
  private readonly kept: Kept;
  private readonly replay: ReplayBar;
  private described: SessionDescription | undefined;
  private isReplay = false;
  /** The session before the replay. */
  private live: string | undefined;

  constructor(
    private readonly desk: Desk,
    view: View,
    keys: Keys,
    private readonly surroundings: Surroundings,
  ) {
    const command = (method: 'control.play' | 'control.pause' | 'control.step' | 'control.reset') =>
      void ask(desk, method, {});
    const actions = {
      play: () => command('control.play'),
      pause: () => command('control.pause'),
      step: () => command('control.step'),
      reset: () => command('control.reset'),
      setSpeed: (speed: number) => void ask(desk, 'control.set_speed', { speed }),
    };
    this.playback = new Playback(actions, keys);
    this.sceneFile = new SceneFile({
      load: (scene) => this.load(scene),
      open: (file) => void this.kept.openRecording(file),
      refuse: (words) => desk.fail(words),
    });
    this.gravity = new Gravity((gravity) => ask(desk, 'world.set_gravity', { gravity }));
    this.deviceTilt = new DeviceTilt(
      ({ right, away }) => {
        this.gravity.lean(leanInView(right, away, view.stage.viewDirection()));
      },
      (words) => desk.fail(words),
    );
    this.tools = new Tools(keys, view, this.gravity, surroundings);
    this.pour = new Pour(desk, surroundings.document, view.world, keys);
    this.builder = new Builder(desk, surroundings.document, view, keys, (isPlacing) => {
      this.tools.placing = isPlacing;
    });
    this.vatPad = new VatPad(desk);
    this.parameters = new ParameterForms(desk, surroundings.document);
    this.kept = new Kept(desk, {
      load: (scene) => this.load(scene),
      scenesChanged: () => void this.listScenes(),
      go: (session) => surroundings.go(session),
      play: (file) => surroundings.stream.play(file),
    });
    this.replay = new ReplayBar(desk, view.stage, {
      togglePlaying: () => this.playback.toggle(),
      leave: () => surroundings.go(this.live),
      loop: (wanted) => surroundings.stream.loop(wanted),
      nameOfBody: (body) => surroundings.nameOfBody(body),
    });
    keys.add({
      keys: ['g'],
      sign: 'G',
      words: 'choose a scene',
      act: () => this.gallery.open(),
    });
  }

  /** Called after each connection to the server. */
  enter(): void {
    void this.listScenes();
    void ask(this.desk, 'server.info', {}).then((info) => {
      if (!info) return;
      this.kept.showServer(info);
      this.surroundings.showNode(info.node);
    });
  }

  /** `isNew`: another scene or session; `isEarlier`: a reset or a saved state. */
  describe(description: SessionDescription, isNew: boolean, isEarlier: boolean): void {
    this.isReplay = description.replay !== undefined;
    if (!this.isReplay) this.live = description.session;
    this.scenes.describe(description);
    this.described = description;
    this.levels.describe(description);
    this.gravity.describe(description.gravity, isNew);
    this.pour.describe(description, isEarlier);
    this.builder.describe(description, isNew || isEarlier);
    this.vatPad.describe(description);
    this.parameters.describe(description, isNew || isEarlier);
    this.kept.describe(description);
    this.replay.describe(description);
    this.playback.showPlaying(description.playing);
    this.playback.showSpeed(description.speed);
  }

  handle(event: Event): void {
    if (event.event === 'session.status') {
      this.playback.showPlaying(event.params.playing);
      this.playback.showSpeed(event.params.speed);
    }
    this.replay.handle(event);
    if (event.event === 'session.closed' && this.isReplay) this.surroundings.go(this.live);
  }

  /** Enables the controls. A replay cannot be changed. */
  enable(isJoined: boolean): void {
    const isLive = isJoined && !this.isReplay;
    this.playback.enable(isJoined, isLive);
    this.scenes.enable(isLive);
    this.levels.enable(isLive);
    this.gravity.enable(isLive);
    this.deviceTilt.enable(isLive);
    this.tools.enable(isLive);
    this.pour.enable(isLive);
    this.builder.enable(isLive);
    this.vatPad.enable(isLive);
    this.parameters.enable(isLive);
    this.sceneFile.enable(isLive);
    this.kept.enable(isJoined, this.isReplay);
  }

  /** Displays the tick of the current frame. */
  showTick(tick: number): void {
    this.replay.showTick(tick);
  }

  /** The position of a replay or a recording; undefined for live sessions. */
  get moment(): number | undefined {
    return this.replay.moment;
  }

  /** Called once per animation frame. */
  update(): void {
    this.replay.update();
  }

  private load(scene: SceneReference, level?: Level): void {
    const params = level === undefined ? { scene } : { scene, level };
    void ask(this.desk, 'scene.load', params).then((done) => {
      if (done) return;
      this.scenes.refresh();
      if (this.described) this.levels.describe(this.described);
    });
  }

  /** Requests the levels of a scene; undefined for a scene outside the catalogue. */
  private async askLevels(scene: string): Promise<SceneLevelsResult | undefined> {
    try {
      return await this.desk.request('scene.levels', { scene });
    } catch {
      return undefined; // a scene of a file, or an older server
    }
  }

  private async listScenes(): Promise<void> {
    const answer = await ask(this.desk, 'scene.list', {});
    if (!answer) return;
    this.scenes.list(answer.scenes);
    this.kept.showScenes(answer.scenes);
  }
}
