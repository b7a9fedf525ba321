/** Direction to the sun in GLSL: a unit vector in world axes, from the viewer's left. */
export const kSun = 'vec3(-0.37, -0.46, 0.807)';
