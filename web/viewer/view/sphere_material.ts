import { ShaderMaterial } from 'three';
import type { Color } from 'three';

/** The sun shines along this from the viewer's left; world axes, z up, unit length. */
const kSun = 'vec3(-0.37, -0.46, 0.807)';

/**
 * A square around each particle, turned to the eye and just large enough for the sphere's outline
 * in perspective. Instances give the centre in the frame of the model matrix: grid steps for bodies
 * on the frame's grid, body axes for rigid bodies.
 */
const kVertexShader = /* glsl */ `
  in vec3 center;
  uniform float radius;
  flat out vec3 view_center;
  flat out float tint;
  out vec3 view_point;

  void main() {
    view_center = (modelViewMatrix * vec4(center, 1.0)).xyz;
    float distance2 = dot(view_center, view_center);
    vec3 toward = -view_center * inversesqrt(distance2);
    vec3 right = normalize(cross(vec3(0.0, 1.0, 0.0), toward));
    vec3 up = cross(toward, right);
    float outline = radius * sqrt(distance2 / max(distance2 - radius * radius, 0.01 * distance2));
    view_point = view_center + outline * (position.x * right + position.y * up);
    tint = fract(float(gl_InstanceID) * 0.618034) - 0.5;
    gl_Position = projectionMatrix * vec4(view_point, 1.0);
  }
`;

/** Where the eye's ray meets the sphere, and how much of the pixel its outline covers. */
const kSphere = /* glsl */ `
  flat in vec3 view_center;
  flat in float tint;
  in vec3 view_point;
  uniform float radius;
  uniform vec3 color;
  uniform float gloss;
  uniform float opacity;
  uniform mat4 projectionMatrix;

  void main() {
    vec3 ray = normalize(view_point);
    float along = dot(ray, view_center);
    vec3 miss = view_center - along * ray;
    float inside = 1.0 - dot(miss, miss) / (radius * radius);
    float coverage = clamp(inside / fwidth(inside) + 0.5, 0.0, 1.0);
    if (coverage <= 0.0) discard;

    float depth = radius * sqrt(max(inside, 0.0));
    vec3 point = (along - depth) * ray;
    vec3 normal = (point - view_center) / radius;
    vec4 clip = projectionMatrix * vec4(point, 1.0);
    gl_FragDepth = 0.5 * clip.z / clip.w + 0.5;
`;

const kShade = /* glsl */ `
    vec3 n = normal * mat3(viewMatrix);
    float facing = max(dot(normal, -ray), 0.0);
    vec3 sky = mix(vec3(0.42, 0.40, 0.40), vec3(0.80, 0.84, 0.90), 0.5 + 0.5 * n.z);
    float sun = max(0.25 + 0.75 * dot(n, ${kSun}), 0.0);
    float crevice = mix(0.45, 1.0, smoothstep(0.0, 0.75, facing));
    vec3 eye = -ray * mat3(viewMatrix);
    float shine = pow(max(dot(n, normalize(eye + ${kSun})), 0.0), mix(24.0, 90.0, gloss));
    float rim = pow(1.0 - facing, 3.0) * gloss;

    vec3 base = color * (1.0 + 0.16 * tint);
    vec3 light = base * (sky + 0.62 * sun) * crevice;
    light += mix(0.10, 0.65, gloss) * shine + 0.35 * rim * vec3(0.75, 0.9, 1.0);
    gl_FragColor = vec4(light, opacity * coverage);
    #include <colorspace_fragment>
  }
`;

const kDepthOnly = /* glsl */ `
    gl_FragColor = vec4(0.0, 0.0, 0.0, coverage);
  }
`;

export interface SphereLook {
  color: Color;
  /** World radius of the drawn spheres [m]. */
  radius: number;
  /** 0 matt, 1 wet. */
  gloss: number;
  /** Below 1, what lies behind the nearest sphere shines through. */
  opacity: number;
}

function uniforms(look: SphereLook): Record<string, { value: unknown }> {
  return {
    color: { value: look.color },
    radius: { value: look.radius },
    gloss: { value: look.gloss },
    opacity: { value: look.opacity },
  };
}

/** Shaded spheres. Translucent ones need `sphereDepthMaterial` drawn before. */
export function sphereMaterial(look: SphereLook): ShaderMaterial {
  const translucent = look.opacity < 1;
  return new ShaderMaterial({
    vertexShader: kVertexShader,
    fragmentShader: kSphere + kShade,
    uniforms: uniforms(look),
    transparent: translucent,
    depthWrite: !translucent,
    alphaToCoverage: !translucent,
  });
}

/** Writes the depth of the same spheres only, so that just the nearest of a body is seen. */
export function sphereDepthMaterial(look: SphereLook): ShaderMaterial {
  return new ShaderMaterial({
    vertexShader: kVertexShader,
    fragmentShader: kSphere + kDepthOnly,
    uniforms: uniforms(look),
    colorWrite: false,
  });
}
