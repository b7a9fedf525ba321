import { Color, Matrix4, ShaderMaterial, Vector3 } from 'three';
import { kEnvironment } from '../base/environment';
import { kNoise } from '../colour/noise';
import { kSun } from '../base/light';
import { kScreenVertexShader } from '../base/screen';
import { kSunlight } from '../base/sun_uniforms';
import type { SunUniforms } from '../base/sun_uniforms';
import { kWalls } from './wall_uniforms';
import type { WallUniforms } from './wall_uniforms';

/** The blurred coverage at the outline of a liquid. */
const kOutline = 0.42;

const kSurface = /* glsl */ `
  in vec2 at;
  uniform sampler2D behind;
  uniform sampler2D behind_depth;
  uniform sampler2D depth;
  uniform sampler2D thickness;
  uniform mat4 projectionMatrix;
  uniform mat4 projectionMatrixInverse;
  uniform vec3 eye;
  uniform float clarity;
  uniform float paint;
  uniform float radius;
  uniform bool shows_normals;
  uniform vec3 ground;
  uniform float height;

  vec3 ray_at(vec2 place) {
    vec4 far = projectionMatrixInverse * vec4(2.0 * place - 1.0, 1.0, 1.0);
    return far.xyz / -far.z;
  }

  /** Returns the place of the object with this depth that the pixel shows. */
  vec3 window_at(float window_depth) {
    vec4 place = projectionMatrixInverse * vec4(2.0 * vec3(at, window_depth) - 1.0, 1.0);
    return place.xyz / place.w;
  }

  vec4 surface_at(ivec2 place) {
    return texelFetch(depth, clamp(place, ivec2(0), textureSize(depth, 0) - 1), 0);
  }

  vec3 point_at(ivec2 place, float away) {
    return away * ray_at((vec2(place) + 0.5) / vec2(textureSize(depth, 0)));
  }

  /**
   * Returns the slope along one direction, from the side with the smaller step. A larger step than
   * a particle on both sides is an outline, which has no slope.
   */
  vec3 slope(ivec2 here, ivec2 aside, vec3 point) {
    float ahead = surface_at(here + aside).r;
    float back = surface_at(here - aside).r;
    bool takes_back = ahead <= 0.0 || (back > 0.0 && abs(back + point.z) < abs(ahead + point.z));
    float step = takes_back ? back : ahead;
    if (step <= 0.0 || abs(step + point.z) > 2.0 * radius) return vec3(aside, 0.0);
    return takes_back ? point - point_at(here - aside, back) : point_at(here + aside, ahead) - point;
  }

  ${kWalls}

  /**
   * Moves a point that is near to the wall through which the eye sees it to this wall. Returns the
   * share of the wall, 0 to 1.
   */
  float flatten(inout vec3 point, inout vec3 normal) {
    mat3 to_world = transpose(mat3(viewMatrix));
    vec3 way = to_world * point;
    Entry entry = entry_of(eye, way); // 1 is at the point
    if (entry.at <= 0.0) return 0.0;
    float inward = (1.0 - entry.at) * -dot(way, entry.normal);
    float share = 1.0 - smoothstep(0.6 * radius, 1.4 * radius, inward);
    point *= mix(1.0, entry.at, share);
    normal = normalize(mix(normal, mat3(viewMatrix) * entry.normal, share));
    return share;
  }

  vec3 normal_at(ivec2 here, float away) {
    vec3 point = point_at(here, away);
    return normalize(cross(slope(here, ivec2(1, 0), point), slope(here, ivec2(0, 1), point)));
  }
`;

const kLight = /* glsl */ `
  ${kEnvironment}
  ${kSunlight}
  ${kNoise}

  /**
   * Returns the place in the picture where the refracted ray ends: after the length \`inside\` [m]
   * in the liquid, or at a wall or the floor. Long rays would hit other objects than the thickness
   * is measured for. Behind a drop, the ray is bent once more and goes on for the length \`beyond\`.
   */
  vec2 refracted(vec3 point, vec3 ray, vec3 normal, float inside, float beyond, float front) {
    mat3 to_world = transpose(mat3(viewMatrix));
    vec3 way = refract(ray, normal, 0.75);
    float length = min(min(inside, 4.0 * radius), max(exit_of(eye + to_world * point, to_world * way), 0.0));
    vec4 clip = projectionMatrix * vec4(point + length * way + beyond * normalize(2.0 * way - ray), 1.0);
    vec2 bent = clamp(0.5 + 0.5 * clip.xy / clip.w, 0.001, 0.999);
    // Objects in front of the liquid are not refracted.
    return texture(behind_depth, bent).r < front ? at : bent;
  }

  /** \`glass\`: the share of a wall, through which the liquid is seen undistorted. */
  vec3 light_of(vec3 point, vec3 normal, vec4 sum, float room, float foam, float front, float glass) {
    vec3 ray = normalize(point);
    mat3 to_world = transpose(mat3(viewMatrix));
    vec3 n = to_world * normal;
    vec3 world = eye + to_world * point;
    vec3 colour = sum.rgb / sum.w;
    float beyond = clamp(min(room, exit_of(world, to_world * ray)) - 1.6 * sum.w, 0.0, 12.0 * radius);
    vec2 bent = refracted(point, ray, normal, (1.0 - glass) * sum.w, (1.0 - glass) * beyond, front);
    vec3 through = texture(behind, bent).rgb;
    // Beside an object in the liquid, the ray passes more liquid than in front of the object.
    float deep = max(sum.w, texture(thickness, bent).w) / clarity;
    float shade = sunlight(world, n);
    float toward = max(dot(n, ${kSun}), 0.0) * shade;
    float sky = 0.5 + 0.5 * n.z;

    vec3 passed = pow(clamp(colour, 0.03, 0.95), vec3(1.3 * deep)) * (1.0 - paint);
    // Light that small particles and bubbles in the liquid scatter.
    // Behind a drop is the open scene, and the drop is a clear lens.
    float cloudy = mix(0.6, 0.15, smoothstep(0.0, 8.0 * radius, beyond));
    float murk = 1.0 - (1.0 - max(paint, 0.04)) * exp(-cloudy * deep) * (1.0 - paint);
    // Less light reaches the depth of a liquid.
    float deepness = mix(mix(0.45, 1.0, smoothstep(0.0, 0.6, (world.z - floor_z) / height)), 1.0, paint);
    vec3 pale = mix(colour, vec3(dot(colour, vec3(0.2, 0.6, 0.2)) + 0.15), 0.1);
    vec3 own = mix(pale, colour, paint) * (0.25 + 0.30 * sky + 0.70 * toward) * deepness;
    vec3 body = through * passed * mix(1.0, deepness, 0.6 * (1.0 - exp(-deep))) * (1.0 - 0.5 * murk) + own * murk * mix(0.8, 1.0, paint);

    float facing = clamp(dot(normal, -ray), 0.0, 1.0);
    float mirror = (0.02 + 0.98 * pow(1.0 - facing, 5.0)) * mix(1.0, 0.4, paint);
    mirror *= 1.0 - 0.75 * glass; // at grazing angles, reflections would hide the liquid behind a wall
    vec3 bounced = reflect(to_world * ray, n);
    // Below the horizon, the surroundings are the ground of the picture.
    vec3 around = mix(ground, environment(bounced, 0.05), smoothstep(-0.1, 0.1, bounced.z));
    float shine = pow(max(dot(bounced, ${kSun}), 0.0), 250.0);
    vec3 light = mix(body, around, mirror) + 1.6 * shine * shade * (1.0 - 0.6 * paint);
    vec3 white = vec3(0.96, 0.98, 1.0) * (0.74 + 0.14 * sky + 0.14 * toward);
    float froth = foam * (1.0 - glass) * (1.0 - paint); // foam is not at the glass
    if (froth <= 0.02) return light;
    // Foam has bubbles.
    float bubbles = rough_noise(world / (0.5 * radius));
    return mix(light, white, smoothstep(0.15, 0.75, froth * (0.5 + bubbles)));
  }

  void main() {
    vec4 scene = texture(behind, at);
    float window_depth = texture(behind_depth, at).r;
    vec3 light = scene.rgb;
    ivec2 here = ivec2(at * vec2(textureSize(depth, 0)));
    vec4 surface = surface_at(here);
    vec4 sum = texture(thickness, at);
    // One pixel of the outline is partly covered.
    float edge = max(0.5 * fwidth(surface.g), 1e-3);
    float cover = smoothstep(${kOutline} - edge, ${kOutline} + edge, surface.g);
    // The blur has spread the liquid beyond the walls of the vat.
    vec3 way = transpose(mat3(viewMatrix)) * ray_at(at);
    bool is_in_vat = entry_of(eye, way).at <= exit_of(eye, way);
    if (surface.r > 0.0 && cover > 0.0 && sum.w > 0.0 && is_in_vat) {
      vec3 point = point_at(here, surface.r);
      vec3 normal = normal_at(here, surface.r);
      float glass = flatten(point, normal);
      vec4 clip = projectionMatrix * vec4(point, 1.0);
      float front = 0.5 * clip.z / clip.w + 0.5;
      if (front < window_depth) {
        sum /= min(max(surface.g, ${kOutline}) + 0.1, 1.0); // the blur has spread the edge
        // The blur is thinner than the liquid at a wall.
        sum *= max(sum.w, 3.0 * radius * glass) / sum.w;
        // Particles in a narrow gap before an object are wider than the gap.
        float room = distance(window_at(window_depth), point);
        sum *= min(1.0, room / sum.w);
        float foam = surface.b * min(1.0, 0.5 * room / radius);
        if (shows_normals) {
          gl_FragDepth = front;
          gl_FragColor = vec4(0.5 + 0.5 * transpose(mat3(viewMatrix)) * normal, 1.0);
          return;
        }
        light = mix(light, light_of(point, normal, sum, room, foam, front, glass), cover);
        window_depth = front;
      }
    }
    gl_FragDepth = window_depth;
    gl_FragColor = vec4(light, 1.0);
    #include <colorspace_fragment>
  }
`;

/** Composes the liquid and the scene behind it; writes the depths of both. */
export function fluidCompositeMaterial(sun: SunUniforms, walls: WallUniforms): ShaderMaterial {
  return new ShaderMaterial({
    vertexShader: kScreenVertexShader,
    fragmentShader: kSurface + kLight,
    uniforms: {
      ...sun,
      ...walls,
      behind: { value: null },
      behind_depth: { value: null },
      depth: { value: null },
      thickness: { value: null },
      projectionMatrixInverse: { value: new Matrix4() },
      eye: { value: new Vector3() },
      clarity: { value: 1 },
      paint: { value: 0 },
      radius: { value: 1 },
      shows_normals: { value: false },
      ground: { value: new Color() },
      height: { value: 1 },
    },
  });
}
