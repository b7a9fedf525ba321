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
  uniform vec4 floor_bounds;
  uniform vec3 floor_colour;
  uniform vec3 shadow_colour;
  uniform float tile;
  ${kSunlight}

  void main() {
    float dark = 0.9 * (1.0 - sunlight(at, vec3(0.0, 0.0, 1.0)));
    vec2 steps = (at.xy - floor_bounds.xy) / tile;
    vec2 away = abs(fract(steps - 0.5) - 0.5) / max(fwidth(steps), vec2(0.012));
    float joint = 1.0 - smoothstep(0.6, 1.6, min(away.x, away.y));
    float shade = 0.94 + 0.06 * fract(17.31 * sin(dot(floor(steps), vec2(12.99, 78.23))));
    vec3 light = shade * mix(floor_colour, shadow_colour, max(dark, 0.6 * joint));
    // The sky lights the floor too.
    light *= mix(vec3(1.0), through_liquids(at), 0.6) * mix(1.0, caustic(at), 0.8);
    gl_FragColor = vec4(light, 1.0);
    #include <colorspace_fragment>
  }
`;

/** Returns the floor's tiles and the shadows of the shadow map, drawn like shadowMaterial(). */
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
