import {
  Color,
  DepthTexture,
  FloatType,
  HalfFloatType,
  NearestFilter,
  Scene,
  UnsignedIntType,
  Vector2,
  WebGLRenderTarget,
} from 'three';
import type {
  IUniform,
  Layers,
  Mesh,
  PerspectiveCamera,
  ShaderMaterial,
  WebGLRenderer,
} from 'three';
import { screenMesh } from '../base/screen';
import { kLayers } from '../base/layers';
import type { SunUniforms } from '../base/sun_uniforms';
import type { WallUniforms } from './wall_uniforms';
import { fluidCompositeMaterial } from './fluid_composite';
import { smoothingMaterial } from './smoothing';

/** The maximum number of rows of the textures; the surface is smooth, so more do not pay. */
export const kMostRows = 1000;

/** Spacing of the samples of each smoothing pass, relative to the particle radius. */
const kSmoothing = [2, 1.3];

/** Uniforms of the scene behind the liquid. */
export interface BehindUniforms {
  behind_depth: IUniform<DepthTexture | null>;
  /** 1 / size of the thickness texture. */
  texel: IUniform<Vector2>;
  /** See FluidLook. */
  clarity: IUniform<number>;
}

export function behindUniforms(): BehindUniforms {
  return { behind_depth: { value: null }, texel: { value: new Vector2() }, clarity: { value: 1 } };
}

/** The appearance of a fluid. */
export interface FluidLook {
  /** Particle radius [m]. */
  radius: number;
  /** Depth with full colour [m]. */
  clarity: number;
  /** Opacity: 0 for clear water, 1 for paint, which shows coloured quantities. */
  paint: number;
  /** Whether colours are the normals of the surface: (1 + n) / 2 in world axes. */
  showsNormals: boolean;
  /** Height of the scene [m]. */
  height: number;
}

/**
 * Draws liquids as one surface, in three steps: the smoothed depth of the nearest particle per
 * pixel, thickness and colour summed along the ray, and refraction, absorption and reflection.
 * After S. Green, "Screen space fluid rendering for games" (GDC 2010). The filter preserves slopes, as
 * that of N. Truong and C. Yuksel, "A narrow-range filter for screen-space fluid rendering" (2018),
 * but has no thresholds.
 */
export class FluidPass {
  private readonly behind = new WebGLRenderTarget(1, 1, {
    type: HalfFloatType,
    samples: 4,
    depthTexture: new DepthTexture(1, 1, UnsignedIntType),
  });
  private readonly depths = [depthTarget(true), depthTarget(false)] as const;
  private readonly thickness = new WebGLRenderTarget(1, 1, {
    type: HalfFloatType,
    depthBuffer: false,
  });
  private readonly smoothing = smoothingMaterial();
  private readonly smoother = screenMesh(this.smoothing);
  private readonly composite: ShaderMaterial;
  private readonly result: Mesh;
  private readonly screen = new Scene();
  private readonly size = new Vector2();
  /** The maximum number of rows of the textures. Photos have more than moving pictures. */
  mostRows = kMostRows;

  constructor(
    private readonly uniforms: BehindUniforms,
    sun: SunUniforms,
    walls: WallUniforms,
  ) {
    this.composite = fluidCompositeMaterial(sun, walls);
    this.result = screenMesh(this.composite);
    this.screen.add(this.smoother, this.result);
    uniforms.behind_depth.value = this.behind.depthTexture;
    const { uniforms: to } = this.composite;
    to.behind!.value = this.behind.texture;
    to.behind_depth!.value = this.behind.depthTexture;
    to.depth!.value = this.depths[0].texture;
    to.thickness!.value = this.thickness.texture;
  }

  /** Returns the target that a mesh of these layers is drawn to; null: the canvas. */
  targetOf(layers: Layers): WebGLRenderTarget | null {
    if (layers.isEnabled(kLayers.fluidDepth)) return this.depths[0];
    if (layers.isEnabled(kLayers.fluidThickness)) return this.thickness;
    return layers.isEnabled(kLayers.marks) ? null : this.behind;
  }

  /** Draws the scene with its liquids to the canvas. `usual` is the distance of the scene [m]. */
  draw(
    renderer: WebGLRenderer,
    scene: Scene,
    camera: PerspectiveCamera,
    look: FluidLook,
    usual: number,
  ): void {
    this.resize(renderer);
    renderer.setRenderTarget(this.behind);
    this.drawLayer(renderer, scene, camera, kLayers.scene);
    const clearColour = renderer.getClearColor(this.clearColour);
    renderer.setClearColor(0, 0);
    renderer.setRenderTarget(this.depths[0]);
    this.drawLayer(renderer, scene, camera, kLayers.fluidDepth);
    renderer.setRenderTarget(this.thickness);
    this.drawLayer(renderer, scene, camera, kLayers.fluidThickness);
    this.smooth(renderer, camera, look.radius, usual);
    renderer.setClearColor(clearColour, 1);
    this.compose(renderer, camera, look);
    this.drawMarks(renderer, scene, camera);
  }

  private readonly clearColour = new Color();

  private resize(renderer: WebGLRenderer): void {
    const { x, y } = renderer.getDrawingBufferSize(this.size);
    this.behind.setSize(x, y);
    const scale = Math.min(1, this.mostRows / y);
    const [width, height] = [Math.ceil(scale * x), Math.ceil(scale * y)];
    for (const target of this.depths) target.setSize(width, height);
    const [thickWidth, thickHeight] = [Math.ceil(width / 2), Math.ceil(height / 2)];
    this.thickness.setSize(thickWidth, thickHeight);
    this.uniforms.texel.value.set(1 / thickWidth, 1 / thickHeight);
  }

  private drawLayer(
    renderer: WebGLRenderer,
    scene: Scene,
    camera: PerspectiveCamera,
    layer: number,
  ): void {
    camera.layers.set(layer);
    renderer.render(scene, camera);
    camera.layers.set(kLayers.scene);
  }

  private smooth(
    renderer: WebGLRenderer,
    camera: PerspectiveCamera,
    radius: number,
    usual: number,
  ): void {
    const [first, second] = this.depths;
    const { uniforms } = this.smoothing;
    this.smoother.visible = true;
    this.result.visible = false;
    uniforms.radius!.value = radius;
    uniforms.rows_per_slope!.value = 0.5 * first.height * camera.projectionMatrix.elements[5]!;
    uniforms.usual!.value = usual;
    for (const [n, size] of kSmoothing.entries()) {
      uniforms.sigma!.value = size;
      uniforms.blurs_outline!.value = n === 0;
      for (const isAcross of [true, false]) {
        uniforms.depth!.value = (isAcross ? first : second).texture;
        (uniforms.direction!.value as Vector2).set(isAcross ? 1 : 0, isAcross ? 0 : 1);
        renderer.setRenderTarget(isAcross ? second : first);
        renderer.render(this.screen, camera);
      }
    }
  }

  private compose(renderer: WebGLRenderer, camera: PerspectiveCamera, look: FluidLook): void {
    const { uniforms } = this.composite;
    uniforms.projectionMatrixInverse!.value = camera.projectionMatrixInverse;
    uniforms.eye!.value = camera.position;
    uniforms.clarity!.value = look.clarity;
    uniforms.paint!.value = look.paint;
    uniforms.shows_normals!.value = look.showsNormals;
    uniforms.radius!.value = look.radius;
    uniforms.ground!.value = this.clearColour;
    uniforms.height!.value = look.height;
    this.smoother.visible = false;
    this.result.visible = true;
    renderer.setRenderTarget(null);
    renderer.render(this.screen, camera);
  }

  /** Draws the marks over the canvas, with its depths. */
  private drawMarks(renderer: WebGLRenderer, scene: Scene, camera: PerspectiveCamera): void {
    renderer.autoClear = false;
    this.drawLayer(renderer, scene, camera, kLayers.marks);
    renderer.autoClear = true;
  }
}

function depthTarget(depthBuffer: boolean): WebGLRenderTarget {
  return new WebGLRenderTarget(1, 1, {
    type: FloatType,
    minFilter: NearestFilter,
    magFilter: NearestFilter,
    depthBuffer,
  });
}
