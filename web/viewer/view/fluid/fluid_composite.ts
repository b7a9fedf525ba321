import { Color, ShaderMaterial } from 'three';
import { kSun } from '../base/light';
import { kScreenVertexShader } from '../base/screen';

const kSurface = /* glsl */ `
  in vec2 at;
  uniform sampler2D behind;
  uniform sampler2D behind_depth;
  uniform sampler2D depth;
  uniform sampler2D thickness;
  uniform mat4 projectionMatrix;
  uniform mat4 projectionMatrixInverse;
  uniform float clarity;
  uniform float paint;
  uniform float radius;
  uniform vec3 sky_low;
  uniform vec3 sky_high;

  vec3 ray_at(vec2 place) {
    vec4 far = projectionMatrixInverse * vec4(2.0 * place - 1.0, 1.0, 1.0);
    return far.xyz / -far.z;
  }

  float depth_at(ivec2 place) {
    return texelFetch(depth, clamp(place, ivec2(0), textureSize(depth, 0) - 1), 0).r;
  }

  vec3 point_at(ivec2 place, float away) {
    return away * ray_at((vec2(place) + 0.5) / vec2(textureSize(depth, 0)));
  }

  /** Returns the slope along one direction, from the side with the smaller step. */
  vec3 slope(ivec2 here, ivec2 aside, vec3 point) {
    float ahead = depth_at(here + aside);
    float back = depth_at(here - aside);
    bool takes_back = ahead <= 0.0 || (back > 0.0 && abs(back + point.z) < abs(ahead + point.z));
    if (takes_back && back <= 0.0) return vec3(aside, 0.0);
    return takes_back ? point - point_at(here - aside, back) : point_at(here + aside, ahead) - point;
  }

  vec3 normal_at(ivec2 here, float away) {
    vec3 point = point_at(here, away);
    return normalize(cross(slope(here, ivec2(1, 0), point), slope(here, ivec2(0, 1), point)));
  }
`;

const kLight = /* glsl */ `
  vec3 light_of(vec3 normal, vec3 ray, vec4 sum, float window_depth) {
    vec3 colour = sum.rgb / sum.w;
    vec2 bent = at - normal.xy * 0.05 * min(sum.w / clarity, 1.0);
    bent = clamp(bent, 0.001, 0.999);
    // Objects in front of the liquid are not refracted.
    if (texture(behind_depth, bent).r < window_depth) bent = at;
    vec3 through = texture(behind, bent).rgb;
    mat3 to_world = transpose(mat3(viewMatrix));
    vec3 n = to_world * normal;
    vec3 bounced = to_world * reflect(ray, normal);
    float deep = sum.w / clarity;
    vec3 passed = pow(clamp(colour, 0.12, 0.9), vec3(0.9 * deep)) * (1.0 - paint);
    float sun = 0.5 + 0.5 * dot(n, ${kSun});
    vec3 pale = mix(colour, vec3(dot(colour, vec3(0.2, 0.6, 0.2)) + 0.25), 0.25);
    vec3 own = mix(pale, colour, paint) * mix(0.55, 1.2, sun * sun);
    float murk = 1.0 - (1.0 - max(paint, 0.2)) * exp(-0.75 * deep) * (1.0 - paint);
    vec3 body = through * passed * mix(1.0, 0.55, murk) + own * murk * mix(0.75, 0.95, paint);
    float facing = clamp(dot(normal, -ray), 0.0, 1.0);
    float mirror = 0.02 + 0.98 * pow(1.0 - facing, 5.0);
    vec3 sky = mix(sky_low, sky_high, smoothstep(-0.2, 0.7, bounced.z));
    float shine = pow(max(dot(bounced, ${kSun}), 0.0), 120.0);
    return mix(body, sky, mirror * mix(0.85, 0.4, paint)) + 0.9 * shine * (1.0 - 0.6 * paint);
  }

  void main() {
    vec4 scene = texture(behind, at);
    float window_depth = texture(behind_depth, at).r;
    vec3 light = scene.rgb;
    ivec2 here = ivec2(at * vec2(textureSize(depth, 0)));
    float away = depth_at(here);
    vec4 sum = texture(thickness, at);
    if (away > 0.0 && sum.w > 0.0) {
      vec4 clip = projectionMatrix * vec4(point_at(here, away), 1.0);
      float front = 0.5 * clip.z / clip.w + 0.5;
      if (front < window_depth) {
        vec3 wet = light_of(normal_at(here, away), normalize(ray_at(at)), sum, front);
        light = mix(light, wet, smoothstep(0.0, 0.5 * radius, sum.w));
        window_depth = front;
      }
    }
    gl_FragDepth = window_depth;
    gl_FragColor = vec4(light, 1.0);
    #include <colorspace_fragment>
  }
`;

/** Composes the liquid and the scene behind it; writes the depths of both. */
export function fluidCompositeMaterial(): ShaderMaterial {
  return new ShaderMaterial({
    vertexShader: kScreenVertexShader,
    fragmentShader: kSurface + kLight,
    uniforms: {
      behind: { value: null },
      behind_depth: { value: null },
      depth: { value: null },
      thickness: { value: null },
      projectionMatrixInverse: { value: null },
      clarity: { value: 1 },
      paint: { value: 0 },
      radius: { value: 1 },
      sky_low: { value: new Color() },
      sky_high: { value: new Color() },
    },
  });
}
