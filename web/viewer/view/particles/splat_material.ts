import { AddEquation, CustomBlending, GLSL3, OneFactor, ShaderMaterial } from 'three';
import { kImpostorHit, kImpostorVertexShader } from './impostor';
import type { DrawnUniforms } from './impostor';

/** Depth below the nearest splat within which others count, relative to the splat radius. */
const kLayer = 0.6;

const kDepth = /* glsl */ `
    if (inside <= 0.65) discard; // the faint rim must not hide objects behind
    vec3 point = (along - extent * (0.6 * sqrt(inside) - ${kLayer})) * ray;
    gl_FragDepth = depth_of(point);
    shape = tints = vec4(0.0);
  }
`;

/** Each splat is a lens. Normals, depths and colours of overlapping lenses are blended. */
const kSplat = /* glsl */ `
    if (inside <= 0.0) discard;
    vec3 point = (along - 0.6 * extent * sqrt(inside)) * ray;
    gl_FragDepth = depth_of(point);
    vec3 bulge = -miss / extent;
    float weight = inside * inside * inside;
    shape = weight * vec4(0.9 * bulge.xy, point.z, 1.0);
    tints = weight * vec4(base, 1.0);
  }
`;

const kOutputs = /* glsl */ `
  layout(location = 0) out vec4 shape;
  layout(location = 1) out vec4 tints;
`;

/** Splat radius / particle radius. Splats overlap and form a closed surface. */
const kSize = 2;

function splatShader(uniforms: DrawnUniforms, radius: number, shade: string): ShaderMaterial {
  return new ShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: kImpostorVertexShader,
    fragmentShader: kOutputs + kImpostorHit + shade,
    uniforms: { ...uniforms, radius: { value: kSize * radius } },
  });
}

/** Writes depths only, slightly below the surface of the splats. */
export function splatDepthMaterial(body: DrawnUniforms, radius: number): ShaderMaterial {
  const material = splatShader(body, radius, kDepth);
  material.colorWrite = false;
  return material;
}

/** Sums the weighted properties of the surface. LiquidPass divides by the weights. */
export function splatMaterial(body: DrawnUniforms, radius: number): ShaderMaterial {
  const material = splatShader(body, radius, kSplat);
  material.depthWrite = false;
  material.blending = CustomBlending;
  material.blendEquation = AddEquation;
  material.blendSrc = OneFactor;
  material.blendDst = OneFactor;
  return material;
}
