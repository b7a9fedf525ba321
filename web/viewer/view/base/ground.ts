import { Color, Mesh, PlaneGeometry, ShaderMaterial, Vector2 } from 'three';
import type { Box3 } from 'three';
import type { Theme } from './theme';

const kVertexShader = /* glsl */ `
  out vec2 at;
  void main() {
    vec4 world = modelMatrix * vec4(position, 1.0);
    at = world.xy;
    gl_Position = projectionMatrix * viewMatrix * world;
  }
`;

/** Lines of one pixel, fading with the distance from the centre. */
const kFragmentShader = /* glsl */ `
  in vec2 at;
  uniform vec2 middle;
  uniform float spacing;
  uniform float extent;
  uniform vec3 stage;
  uniform vec3 line;

  void main() {
    vec2 steps = at / spacing;
    vec2 away = abs(fract(steps - 0.5) - 0.5) / fwidth(steps);
    float on_line = 1.0 - min(min(away.x, away.y), 1.0);
    float near = 1.0 - smoothstep(0.35 * extent, extent, distance(at, middle));
    gl_FragColor = vec4(mix(stage, line, on_line * near), 1.0);
    #include <colorspace_fragment>
  }
`;

/** Returns the number 1, 2 or 5 times a power of ten that is near `length`. */
export function roundLength(length: number): number {
  const power = 10 ** Math.floor(Math.log10(length));
  const digit = length / power;
  return power * (digit < 1.5 ? 1 : digit < 3.5 ? 2 : digit < 7.5 ? 5 : 10);
}

/** A fixed grid, which makes the motion of the vat visible. */
export class Ground {
  readonly mesh: Mesh<PlaneGeometry, ShaderMaterial>;

  constructor(look: Theme) {
    const material = new ShaderMaterial({
      vertexShader: kVertexShader,
      fragmentShader: kFragmentShader,
      uniforms: {
        middle: { value: new Vector2() },
        spacing: { value: 1 },
        extent: { value: 1 },
        stage: { value: new Color() },
        line: { value: new Color() },
      },
      depthWrite: false,
      depthTest: false,
    });
    this.mesh = new Mesh(new PlaneGeometry(2, 2), material);
    this.mesh.renderOrder = -1;
    this.paint(look);
  }

  /** Places the grid below the box, extending beyond it. */
  fit(box: Box3): void {
    const width = Math.max(box.max.x - box.min.x, box.max.y - box.min.y);
    const x = (box.min.x + box.max.x) / 2;
    const y = (box.min.y + box.max.y) / 2;
    const extent = 1.8 * width;
    const { middle, spacing, extent: reach } = this.mesh.material.uniforms;
    (middle!.value as Vector2).set(x, y);
    spacing!.value = roundLength(width / 10);
    reach!.value = extent;
    this.mesh.position.set(x, y, box.min.z);
    this.mesh.scale.setScalar(extent);
  }

  paint(look: Theme): void {
    const { stage, line } = this.mesh.material.uniforms;
    (stage!.value as Color).copy(look.stage);
    (line!.value as Color).copy(look.grid);
  }
}
