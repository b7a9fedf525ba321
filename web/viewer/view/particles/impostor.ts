import { Color, Vector3 } from 'three';
import type { IUniform } from 'three';
import type { LookUniforms } from '../colour/look_uniforms';
import { kBody } from './body_shader';
import { particleShader } from './texels';
import type { ParticleUniforms } from './texels';

/** Vertices of the square of a particle. */
export const kSquareVertices = 6;

/** Sources of the particles' colours. */
export const kColourSource = {
  body: 0,
  /** The column `value`, in `value_quantum`. */
  column: 1,
  /** The speed of a rigid motion. */
  motion: 2,
};

/** The uniforms of one body, shared by its materials. */
export interface BodyUniforms extends LookUniforms {
  colour: IUniform<Color>;
  roughness: IUniform<number>;
  metalness: IUniform<number>;
  /** A number that differs between bodies, 0 to 1. */
  variant: IUniform<number>;
  colour_source: IUniform<number>;
  value_quantum: IUniform<number>;
  /** Rigid bodies: velocity of the centre [m/s] and angular velocity [rad/s], world axes. */
  linear: IUniform<Vector3>;
  angular: IUniform<Vector3>;
}

/** The uniforms of a material that draws particles. */
export type DrawnUniforms = BodyUniforms & ParticleUniforms;

/** `moves`: whether particles move individually and are interpolated between frames. */
export function bodyUniforms(colour: Color, look: LookUniforms, moves: boolean): BodyUniforms {
  return {
    ...look,
    ...(moves ? {} : { phase: { value: 1 } }),
    colour: { value: colour.clone() },
    roughness: { value: 0.5 },
    metalness: { value: 0 },
    variant: { value: 0 },
    colour_source: { value: kColourSource.body },
    value_quantum: { value: 1 },
    linear: { value: new Vector3() },
    angular: { value: new Vector3() },
  };
}

/**
 * Position of the particle in coordinates of the model matrix (quanta, or body axes for rigid
 * bodies), and the test of the clip plane.
 */
export function placeOfParticle(vertices: number): string {
  return /* glsl */ `
    ${particleShader(vertices)}
    uniform float phase;
    uniform vec4 clip_plane;
    ${kBody}

    vec3 place_of_particle() {
      return mix(before, center, phase);
    }

    bool is_clipped(vec3 world) {
      return dot(clip_plane.xyz, world) > clip_plane.w;
    }
  `;
}

/** A square for each particle: two triangles. */
export const kSquareOfParticle = /* glsl */ `
  ${placeOfParticle(kSquareVertices)}
  vec2 corner_of_square() {
    // 0, 1, 2 and 0, 2, 3 of the corners in order
    int corner = vertex < 3 ? vertex : vertex == 3 ? 0 : vertex - 2;
    return vec2(corner == 1 || corner == 2 ? 1.0 : -1.0, corner > 1 ? 1.0 : -1.0);
  }
`;

/** A square around each particle that faces the eye and covers the sphere's outline in perspective. */
export const kImpostorVertexShader = /* glsl */ `
  ${kSquareOfParticle}
  uniform float radius;
  uniform float value_quantum;
  uniform vec2 value_range;
  uniform sampler2D value_map;
  flat out vec3 view_center;
  flat out vec3 base;
  flat out float extent;
  flat out float rough;
  flat out float foam;
  flat out float lone;
  flat out float density;
  out vec3 view_point;

  vec3 colour_at(Body body, vec3 arm) {
    if (body.colour_source == ${kColourSource.body}) {
      float tint = fract(float(number & 65535u) * 0.618034) - 0.5;
      return body.colour * (1.0 + 0.16 * tint);
    }
    float shown = body.colour_source == ${kColourSource.column}
      ? float(value) * value_quantum
      : length(body.linear + cross(body.angular, arm));
    float at = (shown - value_range.x) / (value_range.y - value_range.x);
    return textureLod(value_map, vec2(clamp(at, 0.002, 0.998), 0.5), 0.0).rgb;
  }

  void main() {
    read_particle();
    vec2 corner = corner_of_square();
    Body body = this_body();
    vec3 place = place_of_particle();
    vec3 world = (body.to_world * vec4(place, 1.0)).xyz;
    if (is_clipped(world)) {
      gl_Position = vec4(2.0, 2.0, 2.0, 1.0); // outside of the picture
      return;
    }
    extent = radius_of_body(radius) * (1.0 - 0.3 * froth.y);
    foam = froth.x;
    lone = froth.y;
    density = density_of_body();
    rough = body.matter.x;
    view_center = (viewMatrix * vec4(world, 1.0)).xyz;
    float distance2 = dot(view_center, view_center);
    vec3 toward = -view_center * inversesqrt(distance2);
    vec3 right = normalize(cross(vec3(0.0, 1.0, 0.0), toward));
    vec3 up = cross(toward, right);
    float outline = extent * sqrt(distance2 / max(distance2 - extent * extent, 0.01 * distance2));
    view_point = view_center + outline * (corner.x * right + corner.y * up);
    base = colour_at(body, mat3(body.to_world) * place);
    gl_Position = projectionMatrix * vec4(view_point, 1.0);
  }
`;

/** The intersection of the eye's ray and the sphere. `inside` is 1 at its centre, 0 at its outline. */
export const kImpostorHit = /* glsl */ `
  flat in vec3 view_center;
  flat in vec3 base;
  in vec3 view_point;
  flat in float extent;
  flat in float rough;
  uniform mat4 projectionMatrix;

  float depth_of(vec3 point) {
    vec4 clip = projectionMatrix * vec4(point, 1.0);
    return 0.5 * clip.z / clip.w + 0.5;
  }

  void main() {
    vec3 ray = normalize(view_point);
    float along = dot(ray, view_center);
    vec3 miss = view_center - along * ray;
    float inside = 1.0 - dot(miss, miss) / (extent * extent);
`;
