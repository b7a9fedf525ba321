import { DoubleSide, ShaderMaterial } from 'three';
import { kColourSource } from '../particles/impostor';
import type { BodyUniforms } from '../particles/impostor';
import { kSun } from '../base/light';

const kVertexShader = /* glsl */ `
  in float amount;
  uniform vec3 colour;
  uniform int colour_source;
  uniform vec2 value_range;
  uniform sampler2D value_map;
  uniform vec3 linear;
  uniform vec3 angular;
  out vec3 view_point;
  out vec3 world_point;
  out vec3 outward;
  out vec3 base;

  void main() {
    world_point = (modelMatrix * vec4(position, 1.0)).xyz;
    view_point = (viewMatrix * vec4(world_point, 1.0)).xyz;
    outward = mat3(modelMatrix) * normal;
    base = colour;
    if (colour_source != ${kColourSource.body}) {
      vec3 arm = mat3(modelMatrix) * position;
      float shown = colour_source == ${kColourSource.column}
        ? amount
        : length(linear + cross(angular, arm));
      float at = (shown - value_range.x) / (value_range.y - value_range.x);
      base = textureLod(value_map, vec2(clamp(at, 0.002, 0.998), 0.5), 0.0).rgb;
    }
    gl_Position = projectionMatrix * vec4(view_point, 1.0);
  }
`;

const kFragmentShader = /* glsl */ `
  in vec3 view_point;
  in vec3 world_point;
  in vec3 outward;
  in vec3 base;
  uniform vec4 clip_plane;
  uniform float roughness;
  uniform float opacity;

  void main() {
    if (dot(clip_plane.xyz, world_point) > clip_plane.w) discard;
    float wet = 1.0 - roughness;
    vec3 n = normalize(outward) * (gl_FrontFacing ? 1.0 : -1.0);
    vec3 eye = normalize(cameraPosition - world_point);
    vec3 bounced = reflect(-eye, n);
    float facing = max(dot(n, eye), 0.0);
    vec3 sky = mix(vec3(0.42, 0.41, 0.42), vec3(0.84, 0.88, 0.94), 0.5 + 0.5 * n.z);
    float sun = max(0.25 + 0.75 * dot(n, ${kSun}), 0.0);
    float shine = pow(max(dot(bounced, ${kSun}), 0.0), mix(24.0, 90.0, wet));
    float mirror = wet * (0.04 + 0.96 * pow(1.0 - facing, 4.0));
    vec3 light = base * (sky + 0.62 * sun);
    vec3 above = mix(vec3(0.4, 0.47, 0.55), vec3(0.95, 0.98, 1.0), smoothstep(-0.3, 0.8, bounced.z));
    light = mix(light, above, 0.6 * mirror) + mix(0.1, 0.6, wet) * shine;
    gl_FragColor = vec4(light, mix(opacity, 1.0, max(mirror, 0.8 * shine)));
    #include <colorspace_fragment>
  }
`;

/** Returns the material of surfaces around a body's particles. */
export function skinMaterial(body: BodyUniforms): ShaderMaterial {
  return new ShaderMaterial({
    vertexShader: kVertexShader,
    fragmentShader: kFragmentShader,
    uniforms: { ...body, opacity: { value: 1 } },
    side: DoubleSide,
    transparent: true,
  });
}
