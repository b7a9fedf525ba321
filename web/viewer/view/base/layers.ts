/** The layers of the camera. All except the first two contain liquids. */
export const kLayers = {
  /** Objects that a liquid covers or refracts. */
  scene: 0,
  /** Marks over the scene. */
  marks: 1,
  splats: 2,
  fluidDepth: 3,
  fluidThickness: 4,
};
