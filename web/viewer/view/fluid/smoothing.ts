import { ShaderMaterial, Vector2 } from 'three';
import { kScreenVertexShader } from '../base/screen';

/** Maximum samples on each side. Close views are smoothed less. */
const kMostSteps = 36;

/**
 * Distances of the surface from a straight line [particle radii] that are smoothed: one standard
 * deviation. Larger ones are steps between sheets of liquid.
 */
const kRange = 2.5;

/** Width of the blur of the outline [particle radii]; it removes the outlines of particles. */
const kOutline = 0.8;

/** The power of the weights of samples beyond an outline, by which the nearest ones dominate. */
const kNearest = '12.0';

const kFragmentShader = /* glsl */ `
  in vec2 at;
  out vec4 smoothed;
  uniform sampler2D depth;
  uniform vec2 direction;
  uniform float sigma;
  uniform float radius;
  uniform float rows_per_slope;
  /** The distance of pixels without liquid, for the width of the filter [m]. */
  uniform float usual;
  uniform bool blurs_outline;

  vec4 texel_at(ivec2 place) {
    ivec2 last = textureSize(depth, 0) - 1;
    return texelFetch(depth, clamp(place, ivec2(0), last), 0);
  }

  void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    vec4 middle = texel_at(here);
    bool is_wet = middle.r > 0.0;
    float rows = radius * rows_per_slope / (is_wet ? middle.r : usual);
    float spread = max(sigma * rows, 0.5);
    float edge = max(${kOutline} * rows, 0.5);
    int steps = min(int(ceil(1.8 * spread)), ${kMostSteps});
    float weights = is_wet ? 1.0 : 0.0;
    float sum = weights * middle.r;
    float foam = weights * middle.b;
    float cover = middle.g;
    float covers = 1.0;
    ivec2 aside = ivec2(direction);
    for (int i = 1; i <= steps; ++i) {
      vec4 a = texel_at(here + i * aside);
      vec4 b = texel_at(here - i * aside);
      float weight = exp(-0.5 * float(i * i) / (spread * spread));
      float part = exp(-0.5 * float(i * i) / (edge * edge));
      cover += part * (a.g + b.g);
      covers += 2.0 * part;
      if (!is_wet) {
        // Continues the nearest sheet beyond its outline.
        vec2 used = pow(weight, ${kNearest}) * step(1e-6, vec2(a.r, b.r));
        sum += used.x * a.r + used.y * b.r;
        foam += used.x * a.b + used.y * b.b;
        weights += used.x + used.y;
        continue;
      }
      // Both samples or none, so that an edge on one side does not displace the surface.
      if (min(a.r, b.r) <= 0.0) continue;
      // The mean does not depend on the slope, which is large at grazing angles.
      float bend = (0.5 * (a.r + b.r) - middle.r) / (${kRange} * radius);
      weight *= exp(-0.5 * bend * bend);
      sum += weight * (a.r + b.r);
      foam += weight * (a.b + b.b);
      weights += 2.0 * weight;
    }
    vec2 surface = weights > 0.0 ? vec2(sum, foam) / weights : vec2(0.0);
    smoothed = vec4(surface.x, blurs_outline ? cover / covers : middle.g, surface.y, 0.0);
  }
`;

/**
 * Smooths distance, coverage and foam (the channels r, g and b) along rows or columns. Preserves
 * steps between sheets of liquid, and continues the distance beyond their outlines.
 */
export function smoothingMaterial(): ShaderMaterial {
  return new ShaderMaterial({
    vertexShader: kScreenVertexShader,
    fragmentShader: kFragmentShader,
    glslVersion: '300 es',
    uniforms: {
      depth: { value: null },
      direction: { value: new Vector2() },
      sigma: { value: 1 },
      radius: { value: 1 },
      rows_per_slope: { value: 1 },
      usual: { value: 1 },
      blurs_outline: { value: true },
    },
    depthTest: false,
    depthWrite: false,
  });
}
