import { ShaderMaterial } from 'three';
import { kImpostorHit, kImpostorVertexShader } from './impostor';
import type { DrawnUniforms } from './impostor';
import { kSun } from '../base/light';

const kShade = /* glsl */ `
    float coverage = clamp(inside / fwidth(inside) + 0.5, 0.0, 1.0);
    if (coverage <= 0.0) discard;
    vec3 point = (along - extent * sqrt(max(inside, 0.0))) * ray;
    vec3 normal = (point - view_center) / extent;
    gl_FragDepth = depth_of(point);

    vec3 n = normal * mat3(viewMatrix);
    vec3 eye = -ray * mat3(viewMatrix);
    float facing = max(dot(normal, -ray), 0.0);
    vec3 sky = mix(vec3(0.42, 0.40, 0.40), vec3(0.80, 0.84, 0.90), 0.5 + 0.5 * n.z);
    float sun = max(0.25 + 0.75 * dot(n, ${kSun}), 0.0);
    float crevice = mix(0.45, 1.0, smoothstep(0.0, 0.75, facing));
    float gloss = 1.0 - rough;
    float shine = pow(max(dot(n, normalize(eye + ${kSun})), 0.0), mix(24.0, 90.0, gloss));

    vec3 light = base * (sky + 0.62 * sun) * crevice + mix(0.10, 0.65, gloss) * shine;
    gl_FragColor = vec4(light, coverage);
    #include <colorspace_fragment>
  }
`;

/** Shaded spheres of this radius [m]. */
export function sphereMaterial(body: DrawnUniforms, radius: number): ShaderMaterial {
  return new ShaderMaterial({
    vertexShader: kImpostorVertexShader,
    fragmentShader: `${kImpostorHit}${kShade}`,
    uniforms: { ...body, radius: { value: radius } },
    alphaToCoverage: true,
  });
}
