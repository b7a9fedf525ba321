import { BufferGeometry, Float32BufferAttribute, Mesh } from 'three';
import type { ShaderMaterial } from 'three';

/** The vertex shader of screenMesh(): `at` is 0 to 1 over the picture. */
export const kScreenVertexShader = /* glsl */ `
  out vec2 at;
  void main() {
    at = 0.5 + 0.5 * position.xy;
    gl_Position = vec4(position.xy, 0.0, 1.0);
  }
`;

/** Returns a triangle that covers the picture. */
export function screenMesh<M extends ShaderMaterial>(material: M): Mesh<BufferGeometry, M> {
  const triangle = new BufferGeometry();
  const corners = [-1, -1, 0, 3, -1, 0, -1, 3, 0];
  triangle.setAttribute('position', new Float32BufferAttribute(corners, 3));
  const mesh = new Mesh(triangle, material);
  mesh.frustumCulled = false;
  return mesh;
}
