import { Matrix4, Vector2 } from 'three';
import type { DepthTexture, IUniform, Texture } from 'three';
import { kSun } from './light';

/** The shadow map of the sun, for the materials that receive shadows. */
export interface SunUniforms {
  /** Null until the first shadow map is drawn. */
  sun_map: IUniform<DepthTexture | null>;
  /** From world axes to the shadow map, with coordinates from 0 to 1. */
  to_sun: IUniform<Matrix4>;
  /** Width of a soft edge, relative to the map. */
  sun_blur: IUniform<number>;
  /** Width of a texel of the map [m]. */
  sun_texel: IUniform<number>;
  /** Number of samples of the map for a point, at most kMostSamples. */
  sun_samples: IUniform<number>;
  /** Places of the samples in a disc with the radius 1. */
  sun_disc: IUniform<Vector2[]>;
  /** Optical depth of the liquids in rgb; 1 - depth of their nearest point in the map in alpha. */
  sun_liquid: IUniform<Texture | null>;
  /** Range of the map's depths [m]. */
  sun_range: IUniform<number>;
  floor_z: IUniform<number>;
}

const kMostSamples = 8;
const kGoldenAngle = 2.3999632; // [rad]

/** Returns evenly distributed points of a disc with the radius 1, and zeros up to kMostSamples. */
export function discOf(samples: number): Vector2[] {
  return Array.from({ length: kMostSamples }, (_, i) => {
    const away = i < samples ? Math.sqrt((i + 0.5) / samples) : 0;
    return new Vector2(Math.cos(kGoldenAngle * i), Math.sin(kGoldenAngle * i)).multiplyScalar(away);
  });
}

/** `floor_z`: the height of the floor [m]. */
export function sunUniforms(floor_z: IUniform<number>): SunUniforms {
  return {
    floor_z,
    sun_liquid: { value: null },
    sun_range: { value: 1 },
    sun_map: { value: null },
    to_sun: { value: new Matrix4() },
    sun_blur: { value: 0.002 },
    sun_texel: { value: 0 },
    sun_samples: { value: kMostSamples },
    sun_disc: { value: discOf(kMostSamples) },
  };
}

/** Returns the part of the sun that reaches a point, 0 to 1, in GLSL. `n` is its normal. */
export const kSunlight = /* glsl */ `
  uniform mediump sampler2DShadow sun_map;
  uniform mat4 to_sun;
  uniform float sun_blur;
  uniform float sun_texel;
  uniform int sun_samples;
  uniform vec2 sun_disc[${kMostSamples}];
  uniform sampler2D sun_liquid;
  uniform float sun_range;
  uniform float floor_z;

  float sunlight(vec3 world, vec3 n) {
    if (sun_texel <= 0.0 || dot(n, ${kSun}) <= 0.0) return 1.0; // the dark side needs no shadow
    vec3 at = (to_sun * vec4(world + 1.5 * sun_texel * n, 1.0)).xyz;
    if (any(lessThan(at, vec3(0.0))) || any(greaterThan(at, vec3(1.0)))) return 1.0;
    float sum = 0.0;
    for (int i = 0; i < sun_samples; ++i) {
      sum += texture(sun_map, vec3(at.xy + sun_blur * sun_disc[i], at.z - 0.0015));
    }
    return sum / float(sun_samples);
  }

  /** Returns the part of the sun's red, green and blue that passes the liquids above a point. */
  vec3 through_liquids(vec3 world) {
    vec3 at = (to_sun * vec4(world, 1.0)).xyz;
    if (any(lessThan(at.xy, vec2(0.0))) || any(greaterThan(at.xy, vec2(1.0)))) return vec3(1.0);
    vec4 liquid = texture(sun_liquid, at.xy);
    float above = (at.z - 1.0 + liquid.a) * sun_range;
    if (liquid.a <= 0.0 || above <= 0.0) return vec3(1.0);
    // The depth below the point is unknown. It is assumed to reach the floor.
    float below = max(world.z - floor_z, 0.0) / ${kSun}.z;
    return exp(-liquid.rgb * above / (above + below));
  }

  /** Distance of the samples for the curvature of liquids, relative to the map. */
  const float focus = 0.008;

  float depth_in_sun(vec2 at) {
    return dot(texture(sun_liquid, at).rgb, vec3(1.0));
  }

  /** Returns the sun's light below liquids relative to that without their curvature, which focuses it. */
  float caustic(vec3 world) {
    vec2 at = (to_sun * vec4(world, 1.0)).xy;
    float depth = depth_in_sun(at);
    if (depth <= 0.0) return 1.0;
    float aside = depth_in_sun(at + vec2(focus, 0.0)) + depth_in_sun(at - vec2(focus, 0.0)) +
      depth_in_sun(at + vec2(0.0, focus)) + depth_in_sun(at - vec2(0.0, focus));
    float bend = (depth - 0.25 * aside) / (depth + 0.05);
    // The edges of the liquid in the map are blurred.
    return clamp(1.0 + 4.0 * bend * smoothstep(0.2, 1.2, depth), 0.8, 1.5);
  }
`;
