import { Box3, MathUtils, PerspectiveCamera, Raycaster, Scene, Vector2, Vector3 } from 'three';
import { WebGLRenderer } from 'three';
import type { Object3D, Ray, WebGLRenderTarget } from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { AnimationFrames } from './pace/animation_frames';
import { firstDirection } from './base/presets';
import { isCalm } from './base/calm';
import { fitBox } from './base/fit';
import { Framing } from './base/framed';
import type { Pose } from './base/pose';
import { FluidPass, kMostRows } from './fluid/fluid_pass';
import type { FluidLook } from './fluid/fluid_pass';
import { kLayers } from './base/layers';
import { kSoftwareLevel, Resolution } from './pace/resolution';
import { LiquidPass } from './liquid_pass';
import type { LiquidStyle } from './base/liquid_style';
import type { SharedUniforms } from './bodies/shared_uniforms';
import type { SunShadow } from './shadow/sun_shadow';
import { UnfinishedPictures } from './pace/unfinished_pictures';
import { WarmUp } from './warm_up';
import { graphicsOf } from './base/graphics';
import type { Graphics } from './base/graphics';
import type { Theme } from './base/theme';

/** Space around the scene in the first view, relative to its size. */
const kFirstMargin = 1.08;

/** Renderer, camera and its controls. Draws after changes, at most once per animation frame. */
export class Stage {
  readonly scene = new Scene();
  readonly camera = new PerspectiveCamera(32, 1, 0.01, 100);
  private readonly renderer: WebGLRenderer;
  private readonly controls: OrbitControls;
  private readonly splats = new LiquidPass();
  private readonly fluid: FluidPass;
  private style: LiquidStyle = 'splats';
  private fluidLook: FluidLook | undefined;
  /** Draws the shadow map before each picture, if there is one. */
  sunShadow: SunShadow | undefined;
  private stale = true;
  private readonly frames = new AnimationFrames();
  private readonly resolution: Resolution;
  /** The present picture has this share of the display's rows and columns; 0: there is no picture. */
  private scale = 0;
  private counted = { passes: 0, calls: 0 };
  private readonly warmUp: WarmUp;
  private readonly unfinished: UnfinishedPictures;
  private endWarmUp: (() => void) | undefined;
  /** The properties of the browser's graphics. */
  readonly graphics: Graphics;
  /** Called after each picture: its time [ms], and whether the previous animation frame was drawn. */
  onDrawn: (at: number, follows: boolean) => void = () => undefined;
  /** Called after a change of the resolution of moving pictures. */
  onResolution: () => void = () => undefined;
  /** Called before each picture. */
  prepare: () => void = () => undefined;
  /** Called when the user begins to move the camera. */
  onMoved: () => void = () => undefined;
  private firstMargin = kFirstMargin;
  /** The box in the initial view. */
  private readonly framing = new Framing();
  /** The box in view, and that of the scene. */
  private readonly bounds = new Box3();
  private readonly whole = new Box3();

  /** `beforeDraw` is called once per animation frame. */
  constructor(
    readonly canvas: HTMLCanvasElement,
    shared: SharedUniforms,
    private readonly beforeDraw: () => void,
  ) {
    Object.assign(canvas, this.size); // before the context, so that it is not allocated twice
    this.renderer = new WebGLRenderer({ canvas, antialias: true });
    this.renderer.extensions.has('EXT_texture_filter_anisotropic'); // early, as `graphics`
    this.graphics = graphicsOf(this.renderer); // early, because the browser answers in order
    this.resolution = new Resolution(this.graphics.isSoftware ? kSoftwareLevel : 0);
    this.unfinished = new UnfinishedPictures(this.renderer.getContext() as WebGL2RenderingContext);
    this.warmUp = new WarmUp(this.renderer, this.scene);
    this.renderer.info.autoReset = false; // a picture has several passes
    this.setScale(this.resolution.scale); // early, because a change waits for the graphics
    this.scene.add(this.splats.surface);
    this.fluid = new FluidPass(shared.behind, shared.sun, shared.walls);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = !isCalm();
    this.controls.dampingFactor = 0.12;
    this.controls.maxPolarAngle = 0.495 * Math.PI; // the camera stays above the floor
    this.controls.addEventListener('change', () => this.invalidate());
    this.controls.addEventListener('start', () => {
      this.framing.end();
      this.onMoved();
    });
    canvas.addEventListener('pointerdown', () => this.framing.end()); // it would move held bodies
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement ?? canvas);
    this.renderer.setAnimationLoop(() => this.draw());
  }

  invalidate(): void {
    this.stale = true;
  }

  /** Whether the next animation frame draws a picture. */
  get isStale(): boolean {
    return this.stale;
  }

  /** Whether the pointer rotates the view. */
  set turnable(turnable: boolean) {
    this.controls.enabled = turnable;
  }

  paint(look: Theme): void {
    this.renderer.setClearColor(look.stage);
    this.invalidate();
  }

  /** Sets the style and appearance of liquids; undefined: there are none. */
  showLiquid(style: LiquidStyle, look: FluidLook | undefined): void {
    this.style = style;
    this.fluidLook = look;
    this.splats.surface.visible = style === 'splats' && look !== undefined;
    this.invalidate();
  }

  /** Resolves after the first picture with the present meshes. */
  warm(): Promise<void> {
    this.invalidate();
    return new Promise((resolve) => (this.endWarmUp = resolve));
  }

  /** The work of the last picture: render passes and draw calls. */
  get work(): Readonly<{ passes: number; calls: number }> {
    return this.counted;
  }

  /** The share of the display's rows and columns in moving pictures. */
  get movingScale(): number {
    return this.resolution.scale;
  }

  /** Whether the resolution of moving pictures does not fall any more. */
  get isAdapted(): boolean {
    return this.resolution.isFinal;
  }

  /** Returns to the first resolution of moving pictures, for another scene. */
  restoreResolution(): void {
    this.resolution.restart();
    this.invalidate();
  }

  /** Width and height of a still picture [px]. */
  get size(): { width: number; height: number } {
    const { clientWidth, clientHeight } = this.canvas.parentElement ?? this.canvas;
    const ratio = fullRatio();
    return { width: Math.floor(ratio * clientWidth), height: Math.floor(ratio * clientHeight) };
  }

  /** Returns to the initial view of the next box of `follow`. */
  reframe(): void {
    this.framing.begin();
  }

  /** Keeps this box of a scene in view until the camera is moved. */
  follow(box: Box3, scene: Box3): void {
    this.bounds.copy(box);
    this.whole.copy(scene);
    if (this.framing.follow(box)) this.showFramed();
  }

  /** Returns the ray from the eye through a point of the window. */
  rayThrough(clientX: number, clientY: number): Ray {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const point = new Vector2(
      (2 * (clientX - left)) / width - 1,
      1 - (2 * (clientY - top)) / height,
    );
    const caster = new Raycaster();
    caster.setFromCamera(point, this.camera);
    return caster.ray;
  }

  /** Returns the direction of view. */
  viewDirection(): Vector3 {
    return this.camera.getWorldDirection(new Vector3());
  }

  /** The pose of the camera. */
  get pose(): Pose {
    return { eye: this.camera.position.clone(), target: this.controls.target.clone() };
  }

  set pose({ eye, target }: Pose) {
    this.framing.end();
    this.camera.position.copy(eye);
    this.controls.target.copy(target);
    this.controls.update();
    this.invalidate();
  }

  /** Returns the pose that has the scene in view, from this direction (a unit vector). */
  poseFrom(direction: Vector3): Pose | undefined {
    if (this.bounds.isEmpty()) return undefined;
    const { target, distance } = fitBox(this.bounds, direction, this.camera, this.firstMargin);
    return { eye: target.clone().addScaledVector(direction, distance), target };
  }

  /** Ends drawing and releases the graphics context. */
  dispose(): void {
    this.renderer.setAnimationLoop(null);
    this.controls.dispose();
    this.renderer.dispose();
    this.renderer.forceContextLoss();
  }

  private showFramed(): void {
    const { box } = this.framing;
    if (!box) return;
    const from = firstDirection(this.whole);
    const { target, distance } = fitBox(box, from, this.camera, this.firstMargin);
    this.camera.position.copy(target).addScaledVector(from, distance);
    this.camera.near = distance / 100;
    this.camera.far = distance * 20;
    this.camera.updateProjectionMatrix();
    this.controls.target.copy(target);
    this.controls.minDistance = distance / 20;
    this.controls.maxDistance = distance * 5;
    this.controls.update();
    this.invalidate();
  }

  /**
   * Draws one picture at another size [px]. `use` must read the canvas immediately, because the
   * canvas is then drawn anew at its size.
   * @throws Error if the graphics cannot draw this size.
   */
  drawAt({ width, height }: { width: number; height: number }, use: () => void): void {
    const { renderer, camera, canvas } = this;
    const ratio = renderer.getPixelRatio();
    const { fov, aspect } = camera;
    const scale = height / (canvas.parentElement ?? canvas).clientHeight; // of lines
    const rest = 0.01 / scale; // so that rounding down gives the size
    renderer.setDrawingBufferSize(width / scale + rest, height / scale + rest, scale);
    camera.clearViewOffset();
    camera.aspect = width / height;
    // A narrower picture shows the full width.
    const wider = Math.max(aspect / camera.aspect, 1);
    camera.fov = MathUtils.RAD2DEG * 2 * Math.atan(wider * Math.tan(MathUtils.DEG2RAD * 0.5 * fov));
    camera.updateProjectionMatrix();
    this.fluid.mostRows = height;
    try {
      const { drawingBufferWidth, drawingBufferHeight } = renderer.getContext();
      if (drawingBufferWidth !== width || drawingBufferHeight !== height) {
        throw new Error(`the graphics cannot draw ${width} × ${height} pixels`);
      }
      this.drawNow();
      use();
    } finally {
      this.fluid.mostRows = kMostRows;
      camera.fov = fov;
      renderer.setPixelRatio(ratio);
      this.resize();
      this.drawNow();
    }
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.canvas.parentElement ?? this.canvas;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    this.reserve(clientWidth, clientHeight);
    this.showFramed();
    this.invalidate();
  }

  /** Centres the picture above the controls that the style sheet places over its lower edge. */
  private reserve(width: number, height: number): void {
    const style = getComputedStyle(this.canvas).getPropertyValue('--reserved-bottom');
    const reserved = Math.min(parseFloat(style) || 0, height / 2);
    this.firstMargin = (kFirstMargin * height) / (height - reserved);
    if (reserved > 0) this.camera.setViewOffset(width, height, 0, reserved / 2, width, height);
    else this.camera.clearViewOffset();
    this.camera.updateProjectionMatrix();
  }

  private draw(): void {
    if (this.stale && this.unfinished.areMost()) return;
    const at = performance.now();
    this.beforeDraw();
    this.controls.update();
    const { stale } = this;
    const { follows, isIdle, isStill } = this.frames.begin(at, stale);
    if (this.resolution.add(at, follows, isIdle)) this.onResolution();
    // A picture that does not change is drawn once more in full resolution.
    const isLast = !stale && this.scale < 1 && isStill;
    if (!stale && !isLast) return;
    const isWarm = this.warmUp.advance(this.camera, (mesh) => this.targetOf(mesh));
    if (this.canvas.dataset.warm !== String(isWarm)) this.canvas.dataset.warm = String(isWarm);
    if (!isWarm) return;
    if (isLast) this.setScale(1);
    else if (!isStill) this.setScale(this.resolution.scale);
    this.stale = false;
    if (stale) {
      this.frames.drew();
      this.onDrawn(at, follows);
    }
    this.drawNow();
    this.unfinished.add();
    this.endWarmUp?.();
    this.endWarmUp = undefined;
  }

  /** Returns the target that a mesh is drawn to; null: the canvas. */
  private targetOf({ layers }: Object3D): WebGLRenderTarget | null {
    if (layers.isEnabled(kLayers.splats)) return this.splats.target;
    return this.fluidLook && this.style === 'fluid' ? this.fluid.targetOf(layers) : null;
  }

  private setScale(scale: number): void {
    if (scale === this.scale) return;
    this.scale = scale;
    this.canvas.dataset.scale = String(scale);
    this.renderer.setPixelRatio(scale * fullRatio());
  }

  private drawNow(): void {
    const { info } = this.renderer;
    const { frame } = info.render;
    info.reset();
    this.prepare();
    this.drawPasses();
    this.counted = { passes: info.render.frame - frame, calls: info.render.calls };
  }

  private drawPasses(): void {
    const { renderer, scene, camera, fluidLook: look } = this;
    this.sunShadow?.draw(renderer, scene);
    if (look && this.style === 'fluid') {
      const usual = camera.position.distanceTo(this.controls.target);
      this.fluid.draw(renderer, scene, camera, look, usual);
      return;
    }
    if (look && this.style === 'splats') this.splats.draw(renderer, scene, camera);
    camera.layers.enable(kLayers.marks);
    renderer.render(scene, camera);
    camera.layers.set(kLayers.scene);
  }
}

/** Pixels per unit of the style sheet; more than two are not visible. */
function fullRatio(): number {
  return Math.min(window.devicePixelRatio, 2);
}
