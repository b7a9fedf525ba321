import { kSun } from './light';

/**
 * The surroundings in GLSL: a studio with a bright ceiling, a window on the side of the sun, a lamp
 * behind the scene and a darker floor. `environment` blurs it for rough surfaces. `lit` shades a
 * surface in world axes.
 */
export const kEnvironment = /* glsl */ `
  vec3 environment(vec3 way, float rough) {
    float soft = mix(0.04, 0.9, rough);
    float up = smoothstep(-soft - 0.06, soft + 0.06, way.z);
    vec3 sky = mix(vec3(0.56, 0.60, 0.66), vec3(0.90, 0.94, 1.0), smoothstep(0.0, 0.9, way.z));
    vec3 light = mix(vec3(0.27, 0.26, 0.26), sky, up);
    float window = smoothstep(0.80 - 0.8 * soft, 0.90 + 0.3 * soft, dot(way, ${kSun}));
    float strip = smoothstep(0.35 + soft, 0.0, abs(dot(way, vec3(0.86, -0.38, 0.0)) - 0.75));
    light += window * mix(vec3(1.5, 1.45, 1.35), vec3(0.25), rough);
    // A lamp behind the scene, which level surfaces reflect.
    vec2 lamp = smoothstep(vec2(-soft), vec2(soft), vec2(0.62, 0.22) - abs(way.xz - vec2(0.1, 0.52)));
    light += (1.0 - 0.8 * rough) * step(0.0, way.y) * lamp.x * lamp.y * vec3(0.62, 0.62, 0.6);
    return light + (1.0 - rough) * up * strip * vec3(0.22, 0.24, 0.27);
  }

  /** \`shade\`: 0 to 1, the part of the sun that reaches the point; \`open\`: of the sky. */
  vec3 lit(vec3 colour, float rough, float metal, vec3 n, vec3 eye, float shade, float open) {
    float alpha = max(rough * rough, 0.02);
    float facing = clamp(dot(n, eye), 0.0, 1.0);
    float toward = max(dot(n, ${kSun}), 0.0) * shade;
    vec3 between = normalize(eye + ${kSun});
    float spread = dot(n, between) * dot(n, between) * (alpha * alpha - 1.0) + 1.0;
    float lobe = alpha * alpha / (3.14159 * spread * spread);
    float k = 0.5 * alpha + 0.05;
    float visible = 0.25 / ((facing * (1.0 - k) + k) * (toward * (1.0 - k) + k));
    vec3 mirror = mix(vec3(0.04), colour, metal);
    vec3 grazing = mirror + (max(vec3(1.0 - rough), mirror) - mirror) * pow(1.0 - facing, 5.0);
    vec3 sky = mix(vec3(0.27, 0.25, 0.24), vec3(0.48, 0.53, 0.60), 0.5 + 0.5 * n.z);
    vec3 diffuse = colour * (1.0 - metal) * (sky * open + vec3(0.86, 0.81, 0.73) * toward);
    vec3 bounced = environment(reflect(-eye, n), rough) * grazing * mix(open, 1.0, 0.3);
    return diffuse + bounced + min(lobe * visible, 6.0) * toward * mirror;
  }
`;
