import { AddEquation, CustomBlending, GLSL3, OneFactor, ShaderMaterial } from 'three';
import { kImpostorHit, kImpostorVertexShader } from '../particles/impostor';
import type { BodyUniforms } from '../particles/impostor';
import type { BehindUniforms } from './fluid_pass';

const kDepth = /* glsl */ `
    if (inside <= 0.0) discard;
    vec3 point = (along - extent * sqrt(inside)) * ray;
    gl_FragDepth = depth_of(point);
    depth = -point.z;
  }
`;

/** Drawn radius / particle radius. The spheres overlap and form a closed surface. */
const kSize = 1.4;

/** Volume of a drawn sphere / volume of a particle's cube, two radii wide. */
const kShare = 8 / ((4 / 3) * Math.PI * kSize ** 3);

/** The length of the ray in the sphere in front of the scene; it weights the colour. */
const kThickness = /* glsl */ `
    if (inside <= 0.0) discard;
    float half_way = extent * sqrt(inside);
    float window_depth = textureLod(behind_depth, gl_FragCoord.xy * texel, 0.0).r;
    float eye_depth = projectionMatrix[3][2] / (2.0 * window_depth - 1.0 + projectionMatrix[2][2]);
    float before = eye_depth / -ray.z;
    float through = clamp(before - (along - half_way), 0.0, 2.0 * half_way);
    sum = vec4(base, 1.0) * share * density * through;
  }
`;

/** Writes the view distance of the nearest point of each sphere [m]. */
export function fluidDepthMaterial(body: BodyUniforms, radius: number): ShaderMaterial {
  return new ShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: kImpostorVertexShader,
    fragmentShader: `out float depth;\n${kImpostorHit}${kDepth}`,
    uniforms: { ...body, radius: { value: kSize * radius } },
  });
}

/** Sums the liquid thickness along each ray [m], and its colour. */
export function fluidThicknessMaterial(
  body: BodyUniforms,
  radius: number,
  behind: BehindUniforms,
): ShaderMaterial {
  return new ShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: kImpostorVertexShader,
    fragmentShader: `out vec4 sum;\nuniform sampler2D behind_depth;\nuniform vec2 texel;\nuniform float share;\nuniform float density;\n${kImpostorHit}${kThickness}`,
    uniforms: { ...body, ...behind, radius: { value: kSize * radius }, share: { value: kShare } },
    depthTest: false,
    depthWrite: false,
    blending: CustomBlending,
    blendEquation: AddEquation,
    blendSrc: OneFactor,
    blendDst: OneFactor,
  });
}
