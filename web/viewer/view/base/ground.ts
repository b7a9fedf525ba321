import { Color, ShaderMaterial, Vector2, Vector3 } from 'three';
import type { Box3, BufferGeometry, Mesh } from 'three';
import { kSun } from './light';
import { screenMesh } from './screen';
import { kSunlight } from './sun_uniforms';
import type { SunUniforms } from './sun_uniforms';
import type { Theme } from './theme';

const kVertexShader = /* glsl */ `
  out vec3 way;
  void main() {
    vec4 far = inverse(projectionMatrix) * vec4(position.xy, 1.0, 1.0);
    way = transpose(mat3(viewMatrix)) * (far.xyz / far.w);
    gl_Position = vec4(position.xy, 1.0, 1.0);
  }
`;

/**
 * The ground has a pool of light around the scene, lines of one pixel that fade with the distance,
 * and the shadows of the scene. Far from the scene, ground and sky have the same colour.
 */
const kFragmentShader = /* glsl */ `
  in vec3 way;
  uniform vec2 middle;
  uniform float height;
  uniform float spacing;
  uniform float extent;
  uniform vec3 stage;
  uniform vec3 ground;
  uniform vec3 sky;
  uniform vec3 line;
  uniform vec3 shadow;
  /** The extent of the objects that cast shadows. */
  uniform vec3 low;
  uniform vec3 high;
  ${kSunlight}

  /** Whether an object can be between a point and the sun. The samples of the map take most time. */
  bool is_in_shadow(vec3 point) {
    vec3 to_low = (low - point) / ${kSun};
    vec3 to_high = (high - point) / ${kSun};
    vec3 enter = min(to_low, to_high);
    vec3 leave = max(to_low, to_high);
    return max(enter.x, max(enter.y, enter.z)) < min(leave.x, min(leave.y, leave.z));
  }

  void main() {
    vec3 ray = normalize(way);
    bool is_ground = ray.z * (cameraPosition.z - height) < 0.0;
    float steep = is_ground ? ray.z : -1.0; // for the derivatives at the horizon
    vec2 at = cameraPosition.xy - (cameraPosition.z - height) / steep * ray.xy;
    vec2 steps = at / spacing;
    vec2 away = abs(fract(steps - 0.5) - 0.5) / fwidth(steps);
    float on_line = 1.0 - min(min(away.x, away.y), 1.0);
    vec3 light;
    if (is_ground) {
      vec2 out_of = (at - middle) / extent;
      float square = dot(out_of, out_of);
      float near = exp(-1.4 * square);
      light = mix(stage, ground, near);
      vec3 point = vec3(at, height);
      float dark = 0.0;
      if (is_in_shadow(point)) {
        dark = 0.75 * near * (1.0 - sunlight(point, vec3(0.0, 0.0, 1.0)));
        vec3 tint = through_liquids(point);
        light = mix(light, shadow, dark) * mix(vec3(1.0), tint, 0.5 * smoothstep(0.1, 0.6, 1.0 - tint.r));
      }
      light = mix(light, line, 0.7 * on_line * (1.0 - smoothstep(0.12, 1.0, square)) * (1.0 - dark));
    } else {
      light = mix(stage, sky, smoothstep(0.0, 0.5, ray.z));
    }
    gl_FragColor = vec4(light, 1.0);
    #include <colorspace_fragment>
  }
`;

/** Space around objects that cast shadows, relative to their extent. */
const kMargin = 0.05;

/** Returns the number 1, 2 or 5 times a power of ten that is near `length`. */
export function roundLength(length: number): number {
  const power = 10 ** Math.floor(Math.log10(length));
  const digit = length / power;
  return power * (digit < 1.5 ? 1 : digit < 3.5 ? 2 : digit < 7.5 ? 5 : 10);
}

/** The surroundings: a fixed grid on the ground, which makes the motion of the vat visible, and a sky. */
export class Ground {
  readonly mesh: Mesh<BufferGeometry, ShaderMaterial>;

  constructor(look: Theme, sun: SunUniforms) {
    const material = new ShaderMaterial({
      vertexShader: kVertexShader,
      fragmentShader: kFragmentShader,
      uniforms: {
        ...sun,
        middle: { value: new Vector2() },
        height: { value: 0 },
        spacing: { value: 1 },
        extent: { value: 1 },
        stage: { value: new Color() },
        ground: { value: new Color() },
        sky: { value: new Color() },
        line: { value: new Color() },
        shadow: { value: new Color() },
        low: { value: new Vector3() },
        high: { value: new Vector3() },
      },
      depthWrite: false,
    });
    this.mesh = screenMesh(material);
    this.mesh.renderOrder = -1; // below the floor of the vat, which writes no depths
    this.paint(look);
  }

  /** Places the ground below the box. */
  fit(box: Box3): void {
    const width = Math.max(box.max.x - box.min.x, box.max.y - box.min.y);
    const { middle, spacing, extent, height } = this.mesh.material.uniforms;
    (middle!.value as Vector2).set((box.min.x + box.max.x) / 2, (box.min.y + box.max.y) / 2);
    spacing!.value = roundLength(width / 10);
    extent!.value = 1.8 * width;
    height!.value = box.min.z;
  }

  /** Sets the extent of the objects that cast shadows on it, from a sample of their particles. */
  shade({ min, max }: Box3): void {
    const { low, high } = this.mesh.material.uniforms;
    const more = kMargin * max.distanceTo(min);
    (low!.value as Vector3).copy(min).subScalar(more);
    (high!.value as Vector3).copy(max).addScalar(more);
  }

  paint(look: Theme): void {
    const { stage, ground, sky, line, shadow } = this.mesh.material.uniforms;
    (stage!.value as Color).copy(look.stage);
    (ground!.value as Color).copy(look.ground);
    (sky!.value as Color).copy(look.sky);
    (line!.value as Color).copy(look.grid);
    (shadow!.value as Color).copy(look.shadow);
  }
}
