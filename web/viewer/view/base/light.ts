/** Direction to the sun: a unit vector in world axes, from the viewer's left. */
export const kSunWay = [-0.37, -0.46, 0.807] as const;

/** The same in GLSL. */
export const kSun = `vec3(${kSunWay.join(', ')})`;
