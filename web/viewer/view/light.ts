/** Towards the sun, from the viewer's left, in GLSL: world axes, z up, unit length. */
export const kSun = 'vec3(-0.37, -0.46, 0.807)';
