import {
  Box3,
  Color,
  DepthTexture,
  HalfFloatType,
  LessEqualCompare,
  LinearFilter,
  Matrix4,
  OrthographicCamera,
  ShaderMaterial,
  Sphere,
  UnsignedIntType,
  Vector3,
  WebGLRenderTarget,
} from 'three';
import type { Scene, WebGLRenderer } from 'three';
import { kBody } from '../particles/body_shader';
import type { LookUniforms } from '../colour/look_uniforms';
import { kLayers } from '../base/layers';
import { kSunWay } from '../base/light';
import { discOf } from '../base/sun_uniforms';
import type { SunUniforms } from '../base/sun_uniforms';

/** Width and height of the shadow map, and samples of it for a point. */
const kFine = { size: 1024, samples: 8 };
/** The same if the CPU draws. */
const kCoarse = { size: 512, samples: 3 };

/** Width of soft edges / width of the scene. */
const kBlur = 0.012;

/** Height of the space above the scene whose bodies cast shadows / height of the scene. */
const kAbove = 0.5;

const kVertexShader = /* glsl */ `
  in vec3 before;
  uniform float phase;
  in float row;
  ${kBody}
  void main() {
    vec4 world = this_body().to_world * vec4(mix(before, position, phase), 1.0);
    gl_Position = projectionMatrix * viewMatrix * world;
  }
`;

/** From coordinates of the screen, -1 to 1, to those of a texture. */
const kToTexture = new Matrix4().set(0.5, 0, 0, 0.5, 0, 0.5, 0, 0.5, 0, 0, 0.5, 0.5, 0, 0, 0, 1);

/**
 * The shadow map of the sun. It contains the depths of all bodies in the layer of casters, and the
 * optical depth of the liquids.
 */
export class SunShadow {
  private readonly camera = new OrthographicCamera();
  private readonly target: WebGLRenderTarget;
  private isStale = true;
  private readonly material: ShaderMaterial;
  private readonly fitted = new Box3();
  private readonly clearColour = new Color();

  constructor(
    private readonly uniforms: SunUniforms,
    { phase, body_table }: Pick<LookUniforms, 'phase' | 'body_table'>,
    isSoftware: boolean,
  ) {
    const { size, samples } = isSoftware ? kCoarse : kFine;
    uniforms.sun_samples.value = samples;
    uniforms.sun_disc.value = discOf(samples);
    this.target = new WebGLRenderTarget(size, size, { type: HalfFloatType });
    const depths = new DepthTexture(size, size, UnsignedIntType);
    depths.compareFunction = LessEqualCompare;
    depths.minFilter = depths.magFilter = LinearFilter;
    this.target.depthTexture = depths;
    this.camera.up.set(0, 0, 1);
    this.camera.layers.set(kLayers.casters);
    this.material = new ShaderMaterial({
      vertexShader: kVertexShader,
      fragmentShader: 'void main() { gl_FragColor = vec4(0.0); }',
      uniforms: { phase, body_table },
    });
  }

  /** Covers a scene of this extent. */
  fit(box: Box3): void {
    if (box.isEmpty() || box.equals(this.fitted)) return;
    this.fitted.copy(box);
    this.invalidate();
    const all = box.clone();
    all.max.z += kAbove * (box.max.z - box.min.z);
    const { center, radius } = all.getBoundingSphere(new Sphere());
    const { camera, uniforms } = this;
    camera.position.copy(center).addScaledVector(new Vector3(...kSunWay), 2 * radius);
    camera.lookAt(center);
    camera.left = camera.bottom = -radius;
    camera.right = camera.top = radius;
    camera.near = radius;
    camera.far = 3 * radius;
    camera.updateProjectionMatrix();
    camera.updateMatrixWorld();
    uniforms.to_sun.value
      .multiplyMatrices(kToTexture, camera.projectionMatrix)
      .multiply(camera.matrixWorldInverse);
    uniforms.sun_texel.value = (2 * radius) / this.target.width;
    uniforms.sun_blur.value = kBlur / 2;
    uniforms.sun_range.value = 2 * radius;
  }

  /** Notifies that bodies have moved. */
  invalidate(): void {
    this.isStale = true;
  }

  /** Draws the map if bodies have moved. */
  draw(renderer: WebGLRenderer, scene: Scene): void {
    if (this.fitted.isEmpty() || !this.isStale) return;
    this.isStale = false;
    const { uniforms, camera, target } = this;
    // Textures must not be read while they are drawn.
    uniforms.sun_map.value = uniforms.sun_liquid.value = null;
    const clearColour = renderer.getClearColor(this.clearColour);
    renderer.setClearColor(0, 0);
    renderer.setRenderTarget(target);
    scene.overrideMaterial = this.material;
    renderer.render(scene, camera);
    scene.overrideMaterial = null;
    renderer.autoClear = false;
    camera.layers.set(kLayers.liquidShadow);
    renderer.render(scene, camera);
    camera.layers.set(kLayers.casters);
    renderer.autoClear = true;
    renderer.setRenderTarget(null);
    renderer.setClearColor(clearColour, 1);
    uniforms.sun_map.value = target.depthTexture;
    uniforms.sun_liquid.value = target.texture;
  }

  dispose(): void {
    this.target.dispose();
    this.material.dispose();
  }
}
