import { AddEquation, CustomBlending, GLSL3, MaxEquation, OneFactor, ShaderMaterial } from 'three';
import { kImpostorHit, kImpostorVertexShader, kSquareOfParticle } from '../particles/impostor';
import type { DrawnUniforms } from '../particles/impostor';
import { kEllipsoidHit, kEllipsoidVertexShader } from './ellipsoid';
import { kWalls } from './wall_uniforms';
import type { WallUniforms } from './wall_uniforms';
import type { BehindUniforms } from './fluid_pass';

/** Points that are nearer to a wall, in particle radii, are drawn at the wall. */
const kAtWall = 1.2;

/** Points that are nearer to two walls are in a corner [particle radii]; their additional coverage. */
const kInCorner = 1.5;
const kFirm = 1.6;

const kDepth = /* glsl */ `
    if (inside <= 0.0) discard;
    float firm = 1.0;
    vec3 way = transpose(mat3(viewMatrix)) * ray;
    vec3 middle = transpose(mat3(viewMatrix)) * view_center + cameraPosition;
    // Particles can be in the walls by a part of their radius.
    if (all(greaterThan(middle, wall_low - size)) && all(lessThan(middle, wall_high + size))) {
      Entry entry = entry_of(cameraPosition, way);
      float leave = exit_of(cameraPosition, way);
      if (entry.at > leave || farther < entry.at || nearer > leave) discard;
      float inward = (nearer - entry.at) * -dot(way, entry.normal);
      if (entry.at > 0.0 && inward < ${kAtWall} * size) nearer = entry.at;
      vec3 place = cameraPosition + nearer * way;
      vec3 near = step(min(place - wall_low, wall_high - place), vec3(${kInCorner} * size));
      if (near.x + near.y + near.z > 1.0) firm += ${kFirm};
    }
    vec3 point = nearer * ray;
    gl_FragDepth = depth_of(point);
    // The blur of the outline removes no isolated drops and corners. Drops are paler, as spray.
    nearest = vec4(-point.z, firm + lone, max(foam, 0.2 * lone), 0.0);
  }
`;

/** Radius of a blurred particle / particle radius. It is large, so that particles do not appear. */
const kBlurSize = 2.6;

/**
 * The length of the ray in a blurred particle, in front of the scene; it weights the colour. The blur
 * is a normal distribution of the volume of a cube, two particle radii wide.
 */
const kThickness = /* glsl */ `
    if (inside <= 0.0) discard;
    float particle = extent / ${kBlurSize};
    float window_depth = textureLod(behind_depth, gl_FragCoord.xy * texel, 0.0).r;
    float eye_depth = projectionMatrix[3][2] / (2.0 * window_depth - 1.0 + projectionMatrix[2][2]);
    float before = clamp(0.5 + 0.5 * (eye_depth / -ray.z - along) / particle, 0.0, 1.0);
    float through = 1.2732 * particle * exp(-0.5 * dot(miss, miss) / (particle * particle));
    sum = vec4(base, 1.0) * density * before * through;
  }
`;

/** Writes the view distance of the nearest point of each ellipsoid [m], coverage and foam. */
export function fluidDepthMaterial(
  body: DrawnUniforms,
  radius: number,
  walls: WallUniforms,
): ShaderMaterial {
  return new ShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: kEllipsoidVertexShader,
    fragmentShader: `out vec4 nearest;\n${kWalls}${kEllipsoidHit}${kDepth}`,
    uniforms: { ...body, ...walls, radius: { value: radius } },
  });
}

const kShadow = /* glsl */ `
  in vec2 spot;
  in vec3 base;
  in float near;
  flat in vec2 matter;
  out vec4 sum;
  uniform float clarity;

  void main() {
    float away2 = dot(spot, spot);
    if (away2 >= 1.0) discard;
    float through = 1.2732 * matter.x * exp(-0.5 * away2 * ${kBlurSize * kBlurSize});
    vec3 optical = -log(clamp(base, 0.03, 0.95)) * matter.y * through / clarity;
    sum = vec4(optical, away2 < 0.3 ? 1.0 - near : 0.0);
  }
`;

/** A square for each particle that faces the sun. */
const kShadowPlace = /* glsl */ `
  ${kSquareOfParticle}
  uniform float radius;
  out vec2 spot;
  out vec3 base;
  out float near;
  /** Radius and density. */
  flat out vec2 matter;

  void main() {
    read_particle();
    Body body = this_body();
    float size = radius_of_body(radius);
    matter = vec2(size / ${kBlurSize}, density_of_body());
    vec3 world = (body.to_world * vec4(place_of_particle(), 1.0)).xyz;
    vec4 center_in_view = viewMatrix * vec4(world, 1.0);
    spot = corner_of_square();
    base = body.colour;
    gl_Position = projectionMatrix * (center_in_view + vec4(size * spot, 0.0, 0.0));
    near = 0.5 * gl_Position.z + 0.5;
    if (is_clipped(world)) gl_Position = vec4(2.0, 2.0, 2.0, 1.0); // outside of the picture
  }
`;

/**
 * Sums the optical depth of liquids from the sun, for each colour. The alpha channel has the point
 * that is nearest to the sun: 1 - its depth in the map.
 */
export function fluidShadowMaterial(
  body: DrawnUniforms,
  radius: number,
  behind: BehindUniforms,
): ShaderMaterial {
  return new ShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: kShadowPlace,
    fragmentShader: kShadow,
    uniforms: { ...body, clarity: behind.clarity, radius: { value: kBlurSize * radius } },
    depthTest: false,
    depthWrite: false,
    blending: CustomBlending,
    blendEquation: AddEquation,
    blendEquationAlpha: MaxEquation,
    blendSrc: OneFactor,
    blendDst: OneFactor,
  });
}

/** Sums the liquid thickness along each ray [m], and its colour. */
export function fluidThicknessMaterial(
  body: DrawnUniforms,
  radius: number,
  behind: BehindUniforms,
): ShaderMaterial {
  return new ShaderMaterial({
    glslVersion: GLSL3,
    vertexShader: kImpostorVertexShader,
    fragmentShader: `out vec4 sum;\nuniform sampler2D behind_depth;\nuniform vec2 texel;\nflat in float density;\n${kImpostorHit}${kThickness}`,
    uniforms: { ...body, ...behind, radius: { value: kBlurSize * radius } },
    depthTest: false,
    depthWrite: false,
    blending: CustomBlending,
    blendEquation: AddEquation,
    blendSrc: OneFactor,
    blendDst: OneFactor,
  });
}
