/** Value noise in space: smooth, from 0 to 1, without a texture. */
export const kNoise = /* glsl */ `
  float random_at(vec3 cell) {
    uvec3 q = uvec3(ivec3(cell)) * uvec3(1597334673u, 3812015801u, 2798796415u);
    uint n = (q.x ^ q.y ^ q.z) * 1597334673u;
    n = (n ^ (n >> 15u)) * 2246822519u;
    return float(n >> 8u) * (1.0 / 16777216.0);
  }

  vec4 corners(vec3 cell) {
    const vec3 x = vec3(1.0, 0.0, 0.0);
    const vec3 y = vec3(0.0, 1.0, 0.0);
    return vec4(random_at(cell), random_at(cell + x), random_at(cell + y), random_at(cell + x + y));
  }

  float noise(vec3 at) {
    vec3 cell = floor(at);
    vec3 part = at - cell;
    vec3 w = part * part * (3.0 - 2.0 * part);
    vec4 low = corners(cell);
    vec4 high = corners(cell + vec3(0.0, 0.0, 1.0));
    vec4 along_z = mix(low, high, w.z);
    vec2 along_y = mix(along_z.xy, along_z.zw, w.y);
    return mix(along_y.x, along_y.y, w.x);
  }

  float rough_noise(vec3 at) {
    return 0.5 * noise(at) + 0.3 * noise(2.3 * at + 17.0) + 0.2 * noise(5.1 * at + 41.0);
  }
`;
