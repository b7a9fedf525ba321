import { BackSide, BoxGeometry, Color, Mesh, ShaderMaterial, Vector3 } from 'three';
import type { Box3 } from 'three';

const kVertexShader = /* glsl */ `
  uniform vec3 size;
  out vec3 at;
  flat out vec3 facing;
  void main() {
    at = (position + 0.5) * size;
    facing = abs(normal);
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }
`;

/** Lines of one pixel on each wall, except along the wall's normal. */
const kFragmentShader = /* glsl */ `
  in vec3 at;
  flat in vec3 facing;
  uniform float spacing;
  uniform vec3 ink;
  void main() {
    vec3 steps = at / spacing;
    vec3 away = abs(fract(steps - 0.5) - 0.5) / max(fwidth(steps), 1e-6) + 1e6 * step(0.5, facing);
    float on_line = 1.0 - min(min(min(away.x, away.y), away.z), 1.0);
    if (on_line <= 0.0) discard;
    gl_FragColor = vec4(ink, 0.55 * on_line);
    #include <colorspace_fragment>
  }
`;

/** The search cells on the far walls of a box: one support radius wide. */
export class Cells {
  readonly mesh: Mesh<BoxGeometry, ShaderMaterial>;

  constructor() {
    const material = new ShaderMaterial({
      vertexShader: kVertexShader,
      fragmentShader: kFragmentShader,
      uniforms: {
        size: { value: new Vector3() },
        spacing: { value: 1 },
        ink: { value: new Color() },
      },
      side: BackSide,
      transparent: true,
      depthWrite: false,
    });
    this.mesh = new Mesh(new BoxGeometry(1, 1, 1), material);
    this.mesh.visible = false;
  }

  /** Fits the cells to the box, starting at its minimum corner. */
  fit(box: Box3, spacing: number): void {
    const { uniforms } = this.mesh.material;
    box.getCenter(this.mesh.position);
    box.getSize(this.mesh.scale);
    (uniforms.size!.value as Vector3).copy(this.mesh.scale);
    uniforms.spacing!.value = spacing;
  }

  paint(ink: Color): void {
    (this.mesh.material.uniforms.ink!.value as Color).copy(ink);
  }
}
