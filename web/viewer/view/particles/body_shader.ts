/**
 * The values of the body that a vertex belongs to, in GLSL. It needs the number `row`: 1, 2, … for
 * the rows of the table. If it is 0, the values are those of the mesh.
 */
export const kBody = /* glsl */ `
  uniform highp sampler2D body_table;
  uniform vec3 colour;
  uniform int colour_source;
  uniform float roughness;
  uniform float metalness;
  uniform float variant;
  uniform float body_length;
  uniform vec3 linear;
  uniform vec3 angular;

  struct Body {
    mat4 to_world;
    vec3 colour;
    int colour_source;
    /** Roughness, metalness, variant, length. */
    vec4 matter;
    vec3 linear;
    vec3 angular;
  };

  vec4 entry(int n) {
    return texelFetch(body_table, ivec2(n, int(row) - 1), 0);
  }

  /** The radius of the body's particles; \`own\` is that of the mesh, relative to the table's. */
  float radius_of_body(float own) {
    return row < 0.5 ? own : own * entry(5).w;
  }

  /** The absorption of a liquid relative to the reference of the scene; see FluidLook.clarity. */
  float density_of_body() {
    return row < 0.5 ? 1.0 : entry(6).w;
  }

  Body this_body() {
    if (row < 0.5) {
      vec4 matter = vec4(roughness, metalness, variant, body_length);
      return Body(modelMatrix, colour, colour_source, matter, linear, angular);
    }
    vec4 x = entry(0), y = entry(1), z = entry(2), shade = entry(3), at = entry(4);
    mat4 to_world = mat4(vec4(x.xyz, 0.0), vec4(y.xyz, 0.0), vec4(z.xyz, 0.0), vec4(at.xyz, 1.0));
    vec4 matter = vec4(x.w, y.w, z.w, at.w);
    return Body(to_world, shade.rgb, int(shade.w), matter, entry(5).xyz, entry(6).xyz);
  }
`;
