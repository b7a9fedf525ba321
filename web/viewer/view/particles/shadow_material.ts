import { Color, CustomBlending, MinEquation, OneFactor, ShaderMaterial, Vector4 } from 'three';
import { kSquareOfParticle } from './impostor';
import type { DrawnUniforms } from './impostor';

/** The uniforms of the floor with shadows; one object for all bodies. */
export interface FloorUniforms {
  floor_z: { value: number };
  /** Bounds of the floor: min x, min y, max x, max y. */
  floor_bounds: { value: Vector4 };
  /** Width of the floor's tiles [m]. */
  tile: { value: number };
  /** The height above the floor from which particles cast no shadow [m]. */
  reach: { value: number };
  floor_colour: { value: Color };
  shadow_colour: { value: Color };
}

export function floorUniforms(): FloorUniforms {
  return {
    floor_z: { value: 0 },
    floor_bounds: { value: new Vector4() },
    tile: { value: 1 },
    reach: { value: 1 },
    floor_colour: { value: new Color() },
    shadow_colour: { value: new Color() },
  };
}

const kVertexShader = /* glsl */ `
  ${kSquareOfParticle}
  uniform float radius;
  uniform float floor_z;
  uniform float reach;
  out vec2 spot;
  out float strength;
  out vec2 at;

  void main() {
    read_particle();
    vec3 world = (this_body().to_world * vec4(place_of_particle(), 1.0)).xyz;
    strength = clamp(1.0 - (world.z - floor_z) / reach, 0.0, 1.0);
    spot = corner_of_square();
    at = world.xy + 2.2 * radius_of_body(radius) * spot;
    gl_Position = is_clipped(world)
      ? vec4(2.0, 2.0, 2.0, 1.0) // outside of the picture
      : projectionMatrix * viewMatrix * vec4(at, floor_z, 1.0);
  }
`;

const kFragmentShader = /* glsl */ `
  in vec2 spot;
  in float strength;
  in vec2 at;
  uniform vec4 floor_bounds;
  uniform vec3 floor_colour;
  uniform vec3 shadow_colour;

  void main() {
    if (any(lessThan(at, floor_bounds.xy)) || any(greaterThan(at, floor_bounds.zw))) discard;
    float dark = strength * (1.0 - smoothstep(0.0, 1.0, length(spot)));
    gl_FragColor = vec4(mix(floor_colour, shadow_colour, dark), 1.0);
    #include <colorspace_fragment>
  }
`;

/**
 * A soft shadow on the floor below each particle. The darkest value counts, so shadows do not add
 * up. The material is not transparent, so that it is drawn after the floor and before all spheres.
 */
export function shadowMaterial(
  radius: number,
  floor: FloorUniforms,
  body: DrawnUniforms,
): ShaderMaterial {
  return new ShaderMaterial({
    vertexShader: kVertexShader,
    fragmentShader: kFragmentShader,
    uniforms: { ...body, ...floor, radius: { value: radius } },
    depthTest: false,
    depthWrite: false,
    blending: CustomBlending,
    blendEquation: MinEquation,
    blendSrc: OneFactor,
    blendDst: OneFactor,
  });
}
