import { Box3, PerspectiveCamera, Raycaster, Scene, Vector2, Vector3, WebGLRenderer } from 'three';
import type { Ray } from 'three';
import { OrbitControls } from 'three/examples/jsm/controls/OrbitControls.js';
import type { Theme } from './palette';

/** From where the first camera looks at the middle of the scene; z is up. */
const kFirstView = new Vector3(0.42, -1, 0.5).normalize();

/** Renderer, camera and its controls. Draws when something has changed, at most once a frame. */
export class Stage {
  readonly scene = new Scene();
  readonly camera = new PerspectiveCamera(32, 1, 0.01, 100);
  private readonly renderer: WebGLRenderer;
  private readonly controls: OrbitControls;
  private stale = true;

  /** `beforeDraw` runs once in each animation frame. */
  constructor(
    readonly canvas: HTMLCanvasElement,
    private readonly beforeDraw: () => void,
  ) {
    this.renderer = new WebGLRenderer({ canvas, antialias: true });
    this.renderer.setPixelRatio(Math.min(window.devicePixelRatio, 2));
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.12;
    this.controls.maxPolarAngle = 0.495 * Math.PI; // the floor is not seen from below
    this.controls.addEventListener('change', () => this.invalidate());
    new ResizeObserver(() => this.resize()).observe(canvas.parentElement ?? canvas);
    this.renderer.setAnimationLoop(() => this.draw());
  }

  invalidate(): void {
    this.stale = true;
  }

  /** Whether the pointer turns the view. */
  set turnable(turnable: boolean) {
    this.controls.enabled = turnable;
  }

  paint(look: Theme): void {
    this.renderer.setClearColor(look.stage);
    this.invalidate();
  }

  /** Puts the camera where the whole box is seen, whatever the shape of the window. */
  frame(box: Box3): void {
    const middle = box.getCenter(new Vector3());
    this.camera.position.copy(middle).add(kFirstView);
    this.camera.lookAt(middle);
    this.camera.updateMatrixWorld();
    const distance = this.distanceToSee(box);
    this.camera.position.copy(middle).addScaledVector(kFirstView, distance);
    this.camera.near = distance / 100;
    this.camera.far = distance * 20;
    this.camera.updateProjectionMatrix();
    this.controls.target.copy(middle);
    this.controls.minDistance = distance / 20;
    this.controls.maxDistance = distance * 5;
    this.controls.update();
    this.invalidate();
  }

  /** The line from the eye through a point of the window. */
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

  /** Direction in which the camera looks. */
  viewDirection(): Vector3 {
    return this.camera.getWorldDirection(new Vector3());
  }

  /** Least distance from the box's middle, along the first view, with every corner in sight. */
  private distanceToSee(box: Box3): number {
    const margin = 1.12;
    const up = Math.tan((this.camera.fov * Math.PI) / 360) / margin;
    const side = up * this.camera.aspect;
    const middle = box.getCenter(new Vector3());
    const [right, top, back] = [new Vector3(), new Vector3(), new Vector3()];
    this.camera.matrixWorld.extractBasis(right, top, back);
    let distance = 0;
    for (let i = 0; i < 8; ++i) {
      const corner = new Vector3(
        i & 1 ? box.max.x : box.min.x,
        i & 2 ? box.max.y : box.min.y,
        i & 4 ? box.max.z : box.min.z,
      ).sub(middle);
      const needed = Math.max(Math.abs(corner.dot(right)) / side, Math.abs(corner.dot(top)) / up);
      distance = Math.max(distance, needed + corner.dot(back));
    }
    return distance;
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.canvas.parentElement ?? this.canvas;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    this.camera.updateProjectionMatrix();
    this.invalidate();
  }

  private draw(): void {
    this.beforeDraw();
    this.controls.update();
    if (!this.stale) return;
    this.stale = false;
    this.renderer.render(this.scene, this.camera);
  }
}
