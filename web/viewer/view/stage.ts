import { Box3, PerspectiveCamera, Raycaster, Scene, Vector2, Vector3, WebGLRenderer } from 'three';
import type { Ray } from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import { fitBox } from './base/fit';
import type { Pose } from './base/pose';
import { FluidPass } from './fluid/fluid_pass';
import type { FluidLook } from './fluid/fluid_pass';
import { kLayers } from './base/layers';
import { LiquidPass } from './liquid_pass';
import type { LiquidStyle } from './base/liquid_style';
import type { SharedUniforms } from './bodies/shared_uniforms';
import type { SunShadow } from './shadow/sun_shadow';
import { graphicsOf } from './base/graphics';
import type { Graphics } from './base/graphics';
import type { Theme } from './base/theme';

/** Direction of the initial camera from the centre of the scene; z is up. */
const kFirstView = new Vector3(0.42, -1, 0.5).normalize();
const kFirstMargin = 1.15;

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
  private drewLast = false;
  /** Called after each picture: its time [ms], and whether the previous animation frame was drawn. */
  onDrawn: (at: number, follows: boolean) => void = () => undefined;
  private firstMargin = kFirstMargin;
  /** The box in the initial view; undefined after the user has rotated it. */
  private framed: Box3 | undefined = new Box3();

  /** `beforeDraw` is called once per animation frame. */
  constructor(
    readonly canvas: HTMLCanvasElement,
    shared: SharedUniforms,
    private readonly beforeDraw: () => void,
  ) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.scene.add(this.splats.surface);
    this.fluid = new FluidPass(shared.behind);
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.12;
    this.controls.maxPolarAngle = 0.495 * Math.PI; // the camera stays above the floor
    this.controls.addEventListener('change', () => this.invalidate());
    this.controls.addEventListener('start', () => (this.framed = undefined));
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement ?? canvas);
    this.renderer.setAnimationLoop(() => this.draw());
  }

  invalidate(): void {
    this.stale = true;
  }

  /** Whether the pointer rotates the view. */
  set turnable(turnable: boolean) {
    this.controls.enabled = turnable;
  }

  paint(look: Theme): void {
    this.renderer.setClearColor(look.stage);
    this.fluid.paint(look);
    this.invalidate();
  }

  /** Sets the style and appearance of liquids; undefined: there are none. */
  showLiquid(style: LiquidStyle, look: FluidLook | undefined): void {
    this.style = style;
    this.fluidLook = look;
    this.splats.surface.visible = style === 'splats' && look !== undefined;
    this.invalidate();
  }

  /** The properties of the browser's graphics. */
  get graphics(): Graphics {
    return graphicsOf(this.renderer);
  }

  /** Returns to the initial view of the next box of `follow`. */
  reframe(): void {
    this.framed = new Box3();
  }

  /** Keeps the whole box in view until the user rotates it. */
  follow(box: Box3): void {
    if (!this.framed || box.isEmpty() || box.equals(this.framed)) return;
    this.framed.copy(box);
    this.showFramed();
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
    this.framed = undefined;
    this.camera.position.copy(eye);
    this.controls.target.copy(target);
    this.controls.update();
    this.invalidate();
  }

  private showFramed(): void {
    if (!this.framed || this.framed.isEmpty()) return;
    const { target, distance } = fitBox(this.framed, kFirstView, this.camera, this.firstMargin);
    this.camera.position.copy(target).addScaledVector(kFirstView, distance);
    this.camera.near = distance / 100;
    this.camera.far = distance * 20;
    this.camera.updateProjectionMatrix();
    this.controls.target.copy(target);
    this.controls.minDistance = distance / 20;
    this.controls.maxDistance = distance * 5;
    this.controls.update();
    this.invalidate();
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
    this.beforeDraw();
    this.controls.update();
    const drewLast = this.drewLast;
    this.drewLast = this.stale;
    if (!this.stale) return;
    this.stale = false;
    this.onDrawn(performance.now(), drewLast);
    this.drawNow();
  }

  private drawNow(): void {
    const { renderer, scene, camera, fluidLook: look } = this;
    this.sunShadow?.draw(renderer, scene);
    if (look && this.style === 'fluid') {
      this.fluid.draw(renderer, scene, camera, look);
      return;
    }
    if (look && this.style === 'splats') this.splats.draw(renderer, scene, camera);
    camera.layers.enable(kLayers.marks);
    renderer.render(scene, camera);
    camera.layers.set(kLayers.scene);
  }
}
