import type { Attributes, Frame, SessionDescription } from '../../client/index';
import { ColourScale } from './colour/colour_scale';
import { attributeOf, quantityError, quantityOf } from './colour/quantity';
import { setClipPlane } from './base/clip';
import { decideStyle } from './base/liquid_style';
import type { LiquidStyle } from './base/liquid_style';
import { Pace } from './pace/pace';
import type { ViewSettings } from './base/settings';
import { linkedSettings, SettingsStore } from './base/settings_store';
import { shelfOf } from './base/shelf';
import { sharedUniforms } from './bodies/shared_uniforms';
import type { SunShadow } from './shadow/sun_shadow';
import { Stage } from './stage';
import { readTheme, watchTheme } from './base/theme';
import type { Theme } from './base/theme';
import { World } from './world';

/** The source of frames, which receives the requested attributes. */
export interface FrameSource {
  askFor(attributes: Attributes): void;
}

/** The timing of frames; see Playout. */
export interface Motion {
  smooth: boolean;
  phaseAt(now: number): number;
  readonly delaySeconds: number;
}

/** The drawn world with the user's settings. */
export class View {
  readonly stage: Stage;
  readonly world: World;
  readonly scale: ColourScale;
  private readonly shared = sharedUniforms();
  private readonly pace = new Pace();
  private readonly listeners: ((words: string[]) => void)[] = [];
  private sunShadow: SunShadow | undefined;
  private isSlow = false;
  private style: LiquidStyle = 'splats';
  private phase = 1;
  private surfaces = 0;
  private described: SessionDescription | undefined;
  /** The reason for a style that was not chosen. */
  private styleWords: string | undefined;

  /** `beforeDraw` is called once per animation frame. By default, the page has the settings. */
  constructor(
    canvas: HTMLCanvasElement,
    private readonly source: FrameSource,
    private readonly motion: Motion,
    beforeDraw: () => void,
    readonly settings = new SettingsStore(
      shelfOf(window, 'localStorage'),
      linkedSettings(location.href),
    ),
  ) {
    this.stage = new Stage(canvas, this.shared, beforeDraw);
    this.stage.onDrawn = (at, follows) => this.watchPace(at, follows);
    this.stage.onResolution = () => this.tell();
    this.stage.prepare = () => this.world.prepare();
    this.world = new World(this.readTheme(), this.shared);
    this.scale = new ColourScale(this.shared.look);
    this.world.onChange = () => this.showSurface();
    this.world.onValues = (range) => this.scale.add(range);
    this.stage.scene.add(this.world.group);
    this.paint();
    watchTheme(() => this.paint());
    this.settings.subscribe(() => this.apply());
    void this.loadSolids();
  }

  /** Loads the part that draws solids by their shapes. */
  private async loadSolids(): Promise<void> {
    const { solidOf, JoinedSolids, SunShadow, floorShadow } =
      await import('./solids/solid_drawing');
    const { floor, look, sun } = this.shared;
    this.stage.sunShadow = this.sunShadow = new SunShadow(
      sun,
      look,
      this.stage.graphics.isSoftware,
    );
    this.sunShadow.fit(this.world.extent);
    this.world.group.add(floorShadow(floor, sun));
    this.world.drawSolids(solidOf, new JoinedSolids(this.shared));
    await this.stage.warm();
    this.stage.canvas.dataset.solids = 'shapes';
  }

  describe(description: SessionDescription): void {
    const { session, scene } = description;
    const isNew = session !== this.described?.session || scene !== this.described.scene;
    if (isNew) this.stage.restoreResolution();
    this.described = description;
    this.world.describe(description);
    this.scale.forget();
    this.pace.restart();
    this.apply();
  }

  /** Shows a frame. Returns whether it belongs to the described world. */
  show(frame: Frame): boolean {
    if (!this.world.show(frame)) return false;
    this.scale.settle();
    this.sunShadow?.fit(this.world.extent);
    this.sunShadow?.invalidate();
    this.clip(this.settings.settings);
    this.stage.invalidate();
    return true;
  }

  /** Interpolates the picture to `now` [s]. */
  move(now: number): void {
    const phase = this.motion.phaseAt(now);
    if (phase !== this.phase || phase < 1) this.stage.invalidate();
    if (phase !== this.phase) this.sunShadow?.invalidate();
    this.phase = this.world.phase = phase;
  }

  /** The delay for smooth motion [s]. */
  get delaySeconds(): number {
    return this.motion.delaySeconds;
  }

  /** Notifies of texts that explain the picture and its limitations, now and after changes. */
  onWords(listener: (words: string[]) => void): void {
    this.listeners.push(listener);
    this.apply();
  }

  /** Applies the colours of the theme. */
  paint(): void {
    const look = this.readTheme();
    this.world.paint(look);
    this.stage.paint(look);
    this.sunShadow?.invalidate(); // the map is lost with the graphics context
  }

  /** Ends drawing and releases the graphics memory. */
  dispose(): void {
    this.stage.dispose();
  }

  private readTheme(): Theme {
    return readTheme(this.stage.canvas.parentElement ?? document.body);
  }

  private apply(): void {
    this.sunShadow?.invalidate();
    const { settings } = this.settings;
    const { graphics } = this.stage;
    const particles = this.world.liquidParticles;
    const { style, words } = decideStyle(settings.liquid, graphics, this.isSlow, particles);
    this.style = style;
    this.world.liquidStyle = style;
    this.world.solidStyle = settings.solids;
    this.world.colour = settings.colour;
    this.scale.apply(settings);
    this.world.marks.apply(settings);
    const paint = quantityOf(settings.colour) ? 1 : 0;
    const fluid = this.world.fluid;
    this.stage.showLiquid(
      style,
      fluid && { ...fluid, paint, showsNormals: settings.colour === 'normals' },
    );
    this.motion.smooth =
      settings.smooth === 'on' || (settings.smooth === 'auto' && !graphics.isSoftware);
    this.askFor(settings);
    this.clip(settings);
    this.stage.canvas.dataset.liquid = style;
    this.styleWords = words;
    this.tell();
  }

  private tell(): void {
    const percent = Math.round(100 * this.stage.movingScale);
    const parts = [
      this.styleWords,
      percent < 100
        ? `In motion, the picture has ${percent} % of the resolution, to keep up with the display.`
        : undefined,
      ...this.world.marks.words,
    ];
    const all = parts.filter((words) => words !== undefined);
    for (const tell of this.listeners) tell(all);
  }

  /** Draws after a worker has computed a surface. */
  private showSurface(): void {
    this.surfaces += 1;
    this.stage.canvas.dataset.surfaces = String(this.surfaces);
    this.stage.invalidate();
  }

  /** Requests the attributes that colours show, and no others. */
  private askFor({ colour }: ViewSettings): void {
    const name = quantityOf(colour);
    const error = name && quantityError(name, this.world.height);
    this.source.askFor(name ? { [attributeOf(name)]: error } : {});
  }

  private clip(settings: ViewSettings): void {
    setClipPlane(this.shared.look.clip_plane.value, settings, this.world.extent);
    this.stage.invalidate();
  }

  /** Selects the simpler liquid style on slow graphics, unless the user has chosen a style. */
  private watchPace(at: number, follows: boolean): void {
    if (this.isSlow || this.style !== 'fluid' || !this.world.fluid) return;
    if (!this.stage.isAdapted) return; // a lower resolution comes first
    this.pace.add(at, follows);
    if (!this.pace.isSlow) return;
    this.isSlow = true;
    this.apply();
  }
}
