import { DoubleSide, Matrix3, ShaderMaterial } from 'three';
import type { Box3 } from 'three';
import { kBody } from '../particles/body_shader';
import { kEnvironment } from '../base/environment';
import { kSunlight } from '../base/sun_uniforms';
import type { SunUniforms } from '../base/sun_uniforms';
import { kColourSource } from '../particles/impostor';
import type { BodyUniforms } from '../particles/impostor';
import { kFinishShader } from './finishes';

const kVertexShader = /* glsl */ `
  in vec3 rest;
  in vec3 before;
  in float amount;
  uniform float phase;
  uniform vec2 value_range;
  uniform sampler2D value_map;
  in float row;
  ${kBody}
  out vec3 world_point;
  out vec3 outward;
  out vec3 grain;
  out vec3 base;
  flat out vec4 matter;
  flat out int source;

  void main() {
    Body body = this_body();
    vec3 place = mix(before, position, phase);
    world_point = (body.to_world * vec4(place, 1.0)).xyz;
    outward = mat3(body.to_world) * normal;
    grain = rest;
    base = body.colour;
    matter = body.matter;
    source = body.colour_source;
    if (source != ${kColourSource.body}) {
      vec3 arm = mat3(body.to_world) * place;
      float shown = source == ${kColourSource.column}
        ? amount
        : length(body.linear + cross(body.angular, arm));
      float at = (shown - value_range.x) / (value_range.y - value_range.x);
      base = textureLod(value_map, vec2(clamp(at, 0.002, 0.998), 0.5), 0.0).rgb;
    }
    gl_Position = projectionMatrix * viewMatrix * vec4(world_point, 1.0);
  }
`;

const kFragmentShader = /* glsl */ `
  in vec3 world_point;
  in vec3 outward;
  in vec3 grain;
  in vec3 base;
  flat in vec4 matter;
  flat in int source;
  uniform vec4 clip_plane;
  uniform float opacity;
  ${kFinishShader}
  ${kEnvironment}
  ${kSunlight}

  void main() {
    if (dot(clip_plane.xyz, world_point) > clip_plane.w) discard;
    float facing = gl_FrontFacing ? 1.0 : -1.0;
    float metalness = matter.y;
    float body_length = matter.w;
    Surface here = Surface(base, matter.x, 0.0);
    // Colours of quantities have no pattern.
    if (source == ${kColourSource.body}) here = surface_at(grain, base);
    vec3 n = normalize(outward) * facing;
    float shade = sunlight(world_point, n) * dot(through_liquids(world_point), vec3(0.3333));
    n = tilted(n, world_point, here.height * body_length, facing);
    vec3 eye = normalize(cameraPosition - world_point);
    // Near the floor, less light comes from below.
    float above = smoothstep(-0.1, 0.7, (world_point.z - floor_z) / body_length + 0.5 * n.z);
    float open = mix(0.5, 1.0, above);
    float rough = clamp(here.roughness, 0.04, 1.0);
    vec3 light = lit(here.colour, rough, metalness, n, eye, shade, open);
    // A cut shows the inside as a flat surface.
    if (!gl_FrontFacing && clip_plane.xyz != vec3(0.0)) light = 0.7 * base;
    float edge = pow(1.0 - abs(dot(n, eye)), 3.0);
    gl_FragColor = vec4(light, mix(opacity, 1.0, edge * (1.0 - opacity)));
    #include <colorspace_fragment>
  }
`;

/** The uniforms of the surroundings, and the size of details that are not visible [m]. */
export interface Surroundings {
  sun: SunUniforms;
  detail: { value: number };
}

/** Returns the rotation and scale from rest coordinates to the grain: the longest axis first. */
export function grainOf(box: Box3): { toGrain: Matrix3; length: number } {
  const size = box.max.clone().sub(box.min).toArray();
  const axes = [0, 1, 2].sort((a, b) => size[b]! - size[a]! || a - b);
  const length = size[axes[0]!]! || 1;
  const toGrain = new Matrix3();
  toGrain.set(0, 0, 0, 0, 0, 0, 0, 0, 0);
  axes.forEach((axis, row) => (toGrain.elements[3 * axis + row] = 1 / length));
  return { toGrain, length };
}

/** Returns the material of a solid's surface. `length` is the body's longest side [m]. */
export function solidMaterial(
  body: BodyUniforms,
  { sun }: Surroundings,
  length: number,
): ShaderMaterial {
  return new ShaderMaterial({
    vertexShader: kVertexShader,
    fragmentShader: kFragmentShader,
    uniforms: {
      ...body,
      ...sun,
      body_length: { value: length },
      opacity: { value: 1 },
    },
    defines: { FINISH: 0 },
    side: DoubleSide,
  });
}
