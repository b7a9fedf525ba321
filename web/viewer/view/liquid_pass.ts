import { Color, HalfFloatType, ShaderMaterial, Vector2, WebGLRenderTarget } from 'three';
import type { BufferGeometry, Mesh, PerspectiveCamera, Scene, WebGLRenderer } from 'three';
import { kLayers } from './base/layers';
import { kSun } from './base/light';
import { kScreenVertexShader, screenMesh } from './base/screen';

/** Resolution relative to the canvas; splats are soft and need fewer pixels. */
const kScale = 0.5;

const kFragmentShader = /* glsl */ `
  in vec2 at;
  uniform sampler2D shape;
  uniform sampler2D tint;
  uniform mat4 projectionMatrix;
  uniform mat4 projectionMatrixInverse;

  void main() {
    vec4 sum = texture(shape, at);
    float coverage = smoothstep(0.1, 0.24, sum.w);
    if (coverage <= 0.0) discard;
    vec3 normal = vec3(sum.xy / sum.w, 0.0);
    normal.z = sqrt(max(1.0 - dot(normal.xy, normal.xy), 0.01));
    normal = normalize(normal);
    vec3 colour = texture(tint, at).rgb / sum.w;

    vec4 far = projectionMatrixInverse * vec4(2.0 * at - 1.0, 1.0, 1.0);
    vec3 ray = normalize(far.xyz);
    vec3 point = ray * (sum.z / sum.w / ray.z);
    vec4 clip = projectionMatrix * vec4(point, 1.0);
    gl_FragDepth = 0.5 * clip.z / clip.w + 0.5;

    mat3 to_world = transpose(mat3(viewMatrix));
    vec3 n = to_world * normal;
    vec3 bounced = to_world * reflect(ray, normal);
    float facing = clamp(dot(normal, -ray), 0.0, 1.0);
    float mirror = 0.04 + 0.96 * pow(1.0 - facing, 4.0);
    vec3 sky = mix(vec3(0.35, 0.42, 0.5), vec3(0.92, 0.96, 1.0), smoothstep(-0.3, 0.8, bounced.z));
    float sun = 0.5 + 0.5 * dot(n, ${kSun});
    vec3 body = colour * mix(0.45, 1.2, sun * sun);
    float shine = pow(max(dot(bounced, ${kSun}), 0.0), 60.0);
    vec3 light = mix(body, sky, 0.7 * mirror) + 0.55 * shine;
    gl_FragColor = vec4(light, coverage * mix(0.74, 0.96, max(mirror, shine)));
    #include <colorspace_fragment>
  }
`;

/**
 * Draws the splats of all liquid bodies to separate textures, and from these one smooth surface over
 * the canvas. `surface` is part of the scene.
 */
export class LiquidPass {
  readonly surface: Mesh<BufferGeometry, ShaderMaterial>;
  readonly target = new WebGLRenderTarget(1, 1, { count: 2, type: HalfFloatType });

  constructor() {
    const [shape, tint] = this.target.textures;
    const material = new ShaderMaterial({
      vertexShader: kScreenVertexShader,
      fragmentShader: kFragmentShader,
      uniforms: {
        shape: { value: shape },
        tint: { value: tint },
        projectionMatrixInverse: { value: null },
      },
      transparent: true,
    });
    this.surface = screenMesh(material);
    this.surface.renderOrder = 3;
  }

  draw(renderer: WebGLRenderer, scene: Scene, camera: PerspectiveCamera): void {
    const size = renderer.getDrawingBufferSize(new Vector2()).multiplyScalar(kScale).ceil();
    this.target.setSize(size.x, size.y);
    this.surface.material.uniforms.projectionMatrixInverse!.value = camera.projectionMatrixInverse;
    const colour = renderer.getClearColor(new Color());
    renderer.setClearColor(0, 0);
    renderer.setRenderTarget(this.target);
    camera.layers.set(kLayers.splats);
    renderer.render(scene, camera);
    camera.layers.set(kLayers.scene);
    renderer.setRenderTarget(null);
    renderer.setClearColor(colour, 1);
  }
}
