/**
 * A square around each particle, turned to the eye and just large enough for the sphere's outline
 * in perspective. Instances give the centre in the frame of the model matrix: grid steps for bodies
 * on the frame's grid, body axes for rigid bodies.
 */
export const kImpostorVertexShader = /* glsl */ `
  in vec3 center;
  in uint number;
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
    tint = fract(float(number & 65535u) * 0.618034) - 0.5;
    gl_Position = projectionMatrix * vec4(view_point, 1.0);
  }
`;

/** Where the eye's ray meets the sphere: `inside` is 1 in its middle and 0 at the outline. */
export const kImpostorHit = /* glsl */ `
  flat in vec3 view_center;
  flat in float tint;
  in vec3 view_point;
  uniform float radius;
  uniform vec3 colour;
  uniform mat4 projectionMatrix;

  float depth_of(vec3 point) {
    vec4 clip = projectionMatrix * vec4(point, 1.0);
    return 0.5 * clip.z / clip.w + 0.5;
  }

  void main() {
    vec3 ray = normalize(view_point);
    float along = dot(ray, view_center);
    vec3 miss = view_center - along * ray;
    float inside = 1.0 - dot(miss, miss) / (radius * radius);
`;
