import { kFinishes } from '../base/appearance';
import { kNoise } from '../colour/noise';

/** The number of a finish in shaders. */
const number = (name: (typeof kFinishes)[number]): number => kFinishes.indexOf(name);

/**
 * The surface of a finish at a point of the body: colour factors, roughness, and a height in body
 * lengths whose slope tilts the normal. `grain` has the longest axis of the body first, and is 1
 * unit long. `FINISH` is the number of the finish, and `matter` is that of Body.
 */
export const kFinishShader = /* glsl */ `
  ${kNoise}
  struct Surface {
    vec3 colour;
    float roughness;
    float height;
  };

  Surface finish_wood(vec3 grain, Surface plain) {
    // Rings around an axis beside the body, wavy along the grain.
    vec2 heart = vec2(0.35, -0.22) + 0.3 * vec2(matter.z - 0.5, fract(7.0 * matter.z) - 0.5);
    float pale = noise(vec3(2.2 * grain.x, 3.0 * grain.yz) + 9.0 * matter.z);
    float wave = 0.05 * pale;
    float ring = fract(9.0 * (length(grain.yz - heart) + wave));
    float late = smoothstep(0.2, 0.8, ring) * (1.0 - smoothstep(0.8, 1.0, ring));
    float fibre = noise(vec3(7.0 * grain.x, 120.0 * grain.yz));
    plain.colour *= mix(vec3(1.08), vec3(0.80, 0.73, 0.66), late);
    plain.colour *= (0.9 + 0.16 * fibre) * (0.92 + 0.18 * pale);
    plain.roughness += 0.12 * late;
    plain.height = 0.0004 * fibre;
    return plain;
  }

  Surface finish_brick(vec3 grain, Surface plain) {
    float stain = rough_noise(5.0 * grain + 13.0 * matter.z);
    float grit = noise(70.0 * grain);
    float pit = smoothstep(0.68, 0.8, noise(26.0 * grain + 5.0));
    plain.colour *= mix(vec3(0.72, 0.66, 0.64), vec3(1.2, 1.16, 1.1), stain);
    plain.colour *= (0.9 + 0.2 * grit) * (1.0 - 0.45 * pit);
    plain.height = 0.004 * grit - 0.012 * pit + 0.004 * stain;
    return plain;
  }

  Surface finish_rubber(vec3 grain, Surface plain) {
    float dust = rough_noise(40.0 * grain);
    plain.colour *= 0.94 + 0.12 * dust;
    plain.roughness += 0.15 * (dust - 0.5);
    plain.height = 0.0012 * dust;
    return plain;
  }

  Surface finish_steel(vec3 grain, Surface plain) {
    float stroke = noise(vec3(3.0 * grain.x, 160.0 * grain.yz));
    float fine = noise(vec3(9.0 * grain.x, 420.0 * grain.yz));
    float cloud = rough_noise(3.0 * grain + 4.0 * matter.z);
    plain.colour *= 0.9 + 0.12 * stroke + 0.08 * cloud;
    plain.roughness += 0.16 * (stroke - 0.5) + 0.1 * (cloud - 0.5);
    plain.height = 0.0005 * stroke + 0.0003 * fine;
    return plain;
  }

  Surface finish_clay(vec3 grain, Surface plain) {
    float lump = rough_noise(7.0 * grain + 3.0 * matter.z);
    float grit = noise(60.0 * grain);
    plain.colour *= mix(0.82, 1.14, lump) * (0.93 + 0.14 * grit);
    plain.height = 0.012 * lump + 0.002 * grit;
    return plain;
  }

  Surface surface_at(vec3 grain, vec3 base) {
    Surface plain = Surface(base, matter.x, 0.0);
  #if FINISH == ${number('wood')}
    return finish_wood(grain, plain);
  #elif FINISH == ${number('brick')}
    return finish_brick(grain, plain);
  #elif FINISH == ${number('rubber')}
    return finish_rubber(grain, plain);
  #elif FINISH == ${number('steel')}
    return finish_steel(grain, plain);
  #elif FINISH == ${number('clay')}
    return finish_clay(grain, plain);
  #else
    return plain;
  #endif
  }

  /** Tilts a normal by the slope of a height [m] on the screen (M. Mikkelsen, 2010). */
  vec3 tilted(vec3 n, vec3 world, float height, float facing) {
    vec3 along_x = dFdx(world);
    vec3 along_y = dFdy(world);
    vec3 across_x = cross(along_y, n);
    vec3 across_y = cross(n, along_x);
    float area = dot(along_x, across_x) * facing;
    vec3 slope = sign(area) * (dFdx(height) * across_x + dFdy(height) * across_y);
    return normalize(abs(area) * n - slope);
  }
`;
