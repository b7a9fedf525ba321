import { kSquareOfParticle, kSquareVertices } from '../particles/impostor';
import { kRow } from '../particles/texels';
import { kMostShape, kMostShift } from './surface_shapes';
import { kWallPlanes } from './wall_uniforms';

/** A square around each particle's ellipsoid that faces the eye; see SurfaceShapes. */
export const kEllipsoidVertexShader = /* glsl */ `
  ${kSquareOfParticle}
  uniform highp usampler2D shape_texels;
  uniform float radius;
  ${kWallPlanes}
  flat out vec3 view_center;
  /** From view axes to those in which the ellipsoid is a sphere of radius 1. */
  flat out mat3 to_sphere;
  flat out float size;
  flat out float foam;
  flat out float lone;
  out vec3 view_point;

  /** Returns the additional semi-axes of a particle beside walls, so that it fills their corners. */
  vec3 reach_to_walls(vec3 world) {
    vec3 away = min(world - wall_low, wall_high - world) / size;
    return 0.6 * (1.0 - smoothstep(1.3, 2.2, away));
  }

  vec2 entries(uint bits) {
    return ${kMostShape}.0 * unpackSnorm2x16(bits);
  }

  void main() {
    read_particle();
    Body body = this_body();
    size = radius_of_body(radius);
    int particle = gl_VertexID / ${kSquareVertices};
    uvec4 packed_shape = texelFetch(shape_texels, ivec2(particle % ${kRow}, particle / ${kRow}), 0);
    vec2 first = entries(packed_shape.x), second = entries(packed_shape.y), third = entries(packed_shape.z);
    mat3 shape = mat3(
      first.x, second.y, third.x,
      second.y, first.y, third.y,
      third.x, third.y, second.x
    );
    vec3 shift = vec3((uvec3(packed_shape.w) >> uvec3(0, 10, 20)) & 1023u);
    vec3 world = (body.to_world * vec4(place_of_particle(), 1.0)).xyz;
    if (is_clipped(world)) {
      gl_Position = vec4(2.0, 2.0, 2.0, 1.0); // outside of the picture
      return;
    }
    world += size * ${kMostShift}.0 / 511.0 * (shift - 512.0);
    foam = froth.x;
    lone = froth.y;
    vec3 reach = reach_to_walls(world);
    shape[0].x += reach.x;
    shape[1].y += reach.y;
    shape[2].z += reach.z;
    mat3 turn = mat3(viewMatrix);
    mat3 ellipsoid = size * turn * shape * transpose(turn);
    to_sphere = inverse(ellipsoid);
    view_center = (viewMatrix * vec4(world, 1.0)).xyz;
    float distance2 = dot(view_center, view_center);
    vec3 toward = -view_center * inversesqrt(distance2);
    vec3 right = normalize(cross(vec3(0.0, 1.0, 0.0), toward));
    vec3 up = cross(toward, right);
    vec2 corner = corner_of_square();
    vec2 extent = vec2(length(ellipsoid * right), length(ellipsoid * up));
    float depth = length(ellipsoid * toward);
    // The outline in perspective is larger than that in parallel projection.
    float outline = 1.0 / (1.0 - min(depth * inversesqrt(distance2), 0.9));
    view_point = view_center + outline * (extent.x * corner.x * right + extent.y * corner.y * up);
    gl_Position = projectionMatrix * vec4(view_point, 1.0);
  }
`;

/**
 * The intersections of the eye's ray and the ellipsoid: their distances along the ray. `inside` is
 * 1 if the ray meets its centre, 0 at its outline.
 */
export const kEllipsoidHit = /* glsl */ `
  flat in vec3 view_center;
  flat in mat3 to_sphere;
  flat in float size;
  flat in float foam;
  flat in float lone;
  in vec3 view_point;
  uniform mat4 projectionMatrix;

  float depth_of(vec3 point) {
    vec4 clip = projectionMatrix * vec4(point, 1.0);
    return 0.5 * clip.z / clip.w + 0.5;
  }

  void main() {
    vec3 ray = normalize(view_point);
    vec3 way_in = to_sphere * ray;
    vec3 away = to_sphere * view_center;
    float scale = 1.0 / dot(way_in, way_in);
    float along = scale * dot(way_in, away);
    vec3 miss = away - along * way_in;
    float inside = 1.0 - dot(miss, miss);
    float half_way = sqrt(max(scale * inside, 0.0));
    float nearer = along - half_way;
    float farther = along + half_way;
`;
