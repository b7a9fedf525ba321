import { CustomBlending, Mesh, MinEquation, OneFactor, PlaneGeometry, ShaderMaterial } from 'three';
import { kSunlight } from '../base/sun_uniforms';
import type { SunUniforms } from '../base/sun_uniforms';
import type { FloorUniforms } from '../particles/shadow_material';

const kVertexShader = /* glsl */ `
  uniform float floor_z;
  uniform vec4 floor_bounds;
  out vec3 at;

  void main() {
    at = vec3(mix(floor_bounds.xy, floor_bounds.zw, position.xy + 0.5), floor_z);
    gl_Position = projectionMatrix * viewMatrix * vec4(at, 1.0);
  }
`;

const kFragmentShader = /* glsl */ `
  in vec3 at;
  uniform vec3 floor_colour;
  uniform vec3 shadow_colour;
  ${kSunlight}

  void main() {
    float dark = 0.85 * (1.0 - sunlight(at, vec3(0.0, 0.0, 1.0)));
    gl_FragColor = vec4(mix(floor_colour, shadow_colour, dark), 1.0);
    #include <colorspace_fragment>
  }
`;

/** Returns the shadow of the shadow map on the floor, drawn like shadowMaterial(). */
export function floorShadow(floor: FloorUniforms, sun: SunUniforms): Mesh {
  const material = new ShaderMaterial({
    vertexShader: kVertexShader,
    fragmentShader: kFragmentShader,
    uniforms: { ...floor, ...sun },
    depthTest: false,
    depthWrite: false,
    blending: CustomBlending,
    blendEquation: MinEquation,
    blendSrc: OneFactor,
    blendDst: OneFactor,
  });
  const mesh = new Mesh(new PlaneGeometry(1, 1), material);
  mesh.frustumCulled = false;
  mesh.renderOrder = 1;
  return mesh;
}
