import { ShaderMaterial, Vector2 } from 'three';
import { kScreenVertexShader } from '../base/screen';

/** Maximum samples on each side. Close views are smoothed less. */
const kMostSteps = 36;

/** Larger depth differences, in particle radii, belong to another sheet of liquid. */
const kRange = 8;

const kFragmentShader = /* glsl */ `
  in vec2 at;
  out float smoothed;
  uniform sampler2D depth;
  uniform vec2 direction;
  uniform float sigma;
  uniform float radius;
  uniform float rows_per_slope;

  float depth_at(ivec2 place) {
    ivec2 last = textureSize(depth, 0) - 1;
    return texelFetch(depth, clamp(place, ivec2(0), last), 0).r;
  }

  void main() {
    ivec2 here = ivec2(gl_FragCoord.xy);
    float middle = depth_at(here);
    smoothed = middle;
    if (middle <= 0.0) return;
    float spread = max(sigma * rows_per_slope / middle, 0.5);
    int steps = min(int(ceil(1.8 * spread)), ${kMostSteps});
    float narrow = ${kRange}.0 * radius;
    float near = middle - narrow;
    float far = middle + narrow;
    float sum = middle;
    float weights = 1.0;
    ivec2 aside = ivec2(direction);
    for (int i = 1; i <= steps; ++i) {
      float a = depth_at(here + i * aside);
      float b = depth_at(here - i * aside);
      // Both samples or none, so that an edge on one side does not displace the surface.
      if (min(a, b) <= 0.0 || min(a, b) < near) continue;
      float weight = exp(-0.5 * float(i * i) / (spread * spread));
      sum += weight * (min(a, far) + min(b, far));
      weights += 2.0 * weight;
      near = min(near, min(a, b) - narrow);
      if (max(a, b) < far) far = max(far, max(a, b) + narrow);
    }
    smoothed = sum / weights;
  }
`;

/** Smooths depths along rows or columns. Preserves steps between sheets of liquid. */
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
    },
    depthTest: false,
    depthWrite: false,
  });
}
